// The aperture's free width: live, in cm and in shoulder widths (A/S).

import { computed, html } from "../vendor/preact.js";
import { settable } from "../parts/settable.js";
import { session, state } from "../store.js";

const name = computed(() => Object.keys(state.value?.apertures ?? {})[0]);
/** The free width [cm]. */
const width = settable(
  () => 100 * (state.value?.apertures[name.value] ?? 0),
  (cm) => ({ type: "aperture", width: cm / 100, name: name.peek() }),
);

export function Aperture() {
  if (name.value === undefined) return null;
  const cm = width.value.value;
  const { bodies = {}, widths = {} } = session.value?.world ?? {};
  const shoulders = Object.values(bodies).find((body) => body.shoulders)?.shoulders;
  const [least, most] = widths[name.value] ?? [0, Math.round(cm)];
  return html`<label class="aperture" title="The free width of the doorway; it changes while the run goes on, and is recorded">
    <span>${name}</span>
    <input id="aperture" type="range" min=${least} max=${most} step="1" value=${Math.round(cm)} disabled=${!session.value?.alive} onInput=${(event) => width.set(Number(event.currentTarget.value))} />
    <output id="width">${cm.toFixed(0)} cm${shoulders ? html` <span class="quiet">A/S ${(cm / 100 / shoulders).toFixed(2)}</span>` : null}</output>
  </label>`;
}
