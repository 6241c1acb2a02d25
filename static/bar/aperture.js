// The aperture's free width, in cm and in shoulder widths (A/S). A drag, or a key held down, sends one change: the final value.

import { computed, html, signal } from "../vendor/preact.js";
import { optimistic } from "../parts/optimistic_value.js";
import { session, state } from "../store.js";
import { orderChange } from "./branch.js";

const MOVES = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"]; // keys that move a slider

const name = computed(() => Object.keys(state.value?.apertures ?? {})[0]);
/** The free width [cm]. */
const width = optimistic(
  () => 100 * (state.value?.apertures[name.value] ?? 0),
  (cm) => ({ type: "command", word: "aperture", values: [cm / 100], named: { name: name.peek() } }),
  orderChange,
);
/** The value of the slider while it is held [cm]; null otherwise. */
const held = signal(null);
let holding = false;

function move(cm) {
  held.value = cm;
  if (!holding) release();
}

function release() {
  holding = false;
  const cm = held.peek();
  held.value = null;
  if (cm !== null && cm !== Math.round(width.value.peek())) width.set(cm);
}

export function Aperture() {
  if (name.value === undefined) return null;
  const cm = held.value ?? width.value.value;
  const { bodies = {}, widths = {} } = session.value?.world ?? {};
  const shoulders = Object.values(bodies).find((body) => body.shoulders)?.shoulders;
  const reading = html`<output id="width">${cm.toFixed(0)} cm${shoulders ? html` <span class="quiet">A/S ${(cm / 100 / shoulders).toFixed(2)}</span>` : null}</output>`;
  if (!widths[name.value]) return html`<span class="aperture" title="The free width of the doorway; that of a program cannot be changed by hand"><span>${name}</span> ${reading}</span>`;
  const [least, most] = widths[name.value];
  return html`<label class="aperture" title="The free width of the doorway; it changes while the run goes on, and is recorded">
    <span>${name}</span>
    <input
      id="aperture"
      type="range"
      min=${least}
      max=${most}
      step="1"
      value=${Math.round(cm)}
      disabled=${!session.value?.alive}
      onInput=${(event) => move(Number(event.currentTarget.value))}
      onPointerDown=${() => (holding = true)}
      onPointerUp=${release}
      onPointerCancel=${release}
      onKeyDown=${(event) => (holding ||= MOVES.includes(event.key))}
      onKeyUp=${release}
      onBlur=${release}
    />
    ${reading}
  </label>`;
}
