// The free width of an aperture, in cm and in shoulder widths (A/S); if there are several, a list chooses which. A drag, or a key held down,
// sends one change: the final value.

import { noChange } from "../changes/changes.js";
import { computed, html, signal } from "../vendor/preact.js";
import { optimistic } from "../parts/optimistic_value.js";
import { session, state } from "../store.js";
import { sendChange } from "./branch.js";

const MOVES = ["ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown", "Home", "End", "PageUp", "PageDown"]; // keys that move a slider

/** The names of all apertures, as a text, which is the same for each state of a run. */
const names = computed(() => JSON.stringify(Object.keys(state.value?.apertures ?? {})));
/** The name that the user has chosen last. */
const chosen = signal(null);
/** The name of the aperture that is shown. */
const name = computed(() => {
  const all = JSON.parse(names.value);
  return all.includes(chosen.value) ? chosen.value : all[0];
});

const known = new Map();

/** Returns the free width of an aperture [cm], as a value that the user sets and the run confirms. */
function widthOf(name) {
  if (!known.has(name)) {
    const reported = () => 100 * (state.value?.apertures[name] ?? 0);
    const command = (cm) => ({ type: "command", word: "aperture", values: [cm / 100], named: { name } });
    known.set(name, optimistic(reported, command, sendChange));
  }
  return known.get(name);
}

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
  const { value, set } = widthOf(name.peek());
  if (cm !== null && cm !== Math.round(value.peek())) set(cm);
}

/** The name of the aperture, or a list of all. */
function Name() {
  const all = JSON.parse(names.value);
  if (all.length === 1) return html`<label for="aperture">${name}</label>`;
  return html`<select aria-label="Aperture" value=${name.value} onChange=${(event) => (chosen.value = event.currentTarget.value)}>
    ${all.map((one) => html`<option key=${one} value=${one}>${one}</option>`)}
  </select>`;
}

export function Aperture() {
  if (name.value === undefined) return null;
  const cm = held.value ?? widthOf(name.value).value.value;
  const { bodies = {}, widths = {} } = session.value?.world ?? {};
  const shoulders = Object.values(bodies).find((body) => body.shoulders)?.shoulders;
  const reading = html`<output id="width">${cm.toFixed(0)} cm${shoulders ? html` <span class="quiet">A/S ${(cm / 100 / shoulders).toFixed(2)}</span>` : null}</output>`;
  if (!widths[name.value]) return html`<span class="aperture" title="The free width of the doorway"><${Name} /> ${reading}</span>`;
  const [least, most] = widths[name.value];
  return html`<span class="aperture" title=${noChange.value || "The free width of the doorway; it changes while the run goes on, and is recorded"}>
    <${Name} />
    <input
      id="aperture"
      aria-label=${name.value}
      type="range"
      min=${least}
      max=${most}
      step="1"
      value=${Math.round(cm)}
      disabled=${Boolean(noChange.value)}
      onInput=${(event) => move(Number(event.currentTarget.value))}
      onPointerDown=${() => (holding = true)}
      onPointerUp=${release}
      onPointerCancel=${release}
      onKeyDown=${(event) => (holding ||= MOVES.includes(event.key))}
      onKeyUp=${release}
      onBlur=${release}
    />
    ${reading}
  </span>`;
}
