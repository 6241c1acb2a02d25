// Shows the time and the speed of the run.

import { html } from "../vendor/preact.js";
import { state } from "../store.js";

export function Clock() {
  const { time, measured } = state.value ?? {};
  return html`<div class="clock">
    <output id="time" aria-label="Time of the run">${time === undefined ? "–" : `t = ${time.toFixed(2)} s`}</output>
    <output id="measured" aria-label="Measured speed">${measured ? `${measured.toFixed(measured < 1 ? 2 : measured < 100 ? 1 : 0)} x` : ""}</output>
  </div>`;
}
