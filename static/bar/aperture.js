// The aperture's free width: live, in cm and in shoulder widths (A/S).

import { html, useRef, useSignal } from "../vendor/preact.js";
import { order } from "../server.js";
import { alive, session, state } from "../store.js";

const MOST = 200; // [cm]
const HELD = 500; // so long after the last move the slider is the user's, not the run's [ms]

export function Aperture() {
  const slid = useSignal(null); // what the user has set and the run may not show yet [cm]
  const timer = useRef(0);
  const name = Object.keys(state.value?.apertures ?? {})[0];
  if (name === undefined) return null;
  const width = slid.value ?? 100 * state.value.apertures[name];
  const shoulders = Object.values(session.value?.world?.bodies ?? {}).find((body) => body.shoulders)?.shoulders;

  function slide(event) {
    slid.value = Number(event.currentTarget.value);
    clearTimeout(timer.current);
    timer.current = setTimeout(() => (slid.value = null), HELD);
    order({ type: "aperture", width: slid.value / 100, name });
  }

  return html`<label class="aperture" title="The free width of the doorway; it changes while the run goes on, and is recorded">
    <span>${name}</span>
    <input id="aperture" type="range" min="0" max=${MOST} step="1" value=${Math.round(width)} disabled=${!alive.value} onInput=${slide} />
    <output id="width">${width.toFixed(0)} cm${shoulders ? html` <span class="quiet">A/S ${(width / 100 / shoulders).toFixed(2)}</span>` : null}</output>
  </label>`;
}
