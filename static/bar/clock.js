// Shows the time and the speed of the run; the time is a button to go to another one.

import { html } from "../vendor/preact.js";
import { run } from "../commands.js";
import { buttonTitle } from "../keys.js";
import { Button } from "../parts/button.js";
import { alive, state } from "../store.js";
import { goToTime } from "../timeline/go_to_time.js";
import { runTimeText } from "../timeline/seek.js";

export function Clock() {
  const { time, measured } = state.value ?? {};
  const text = time === undefined ? "–" : `t = ${runTimeText(time)}`;
  return html`<div class="clock">
    <${Button} id="time" class="bare" disabled=${!alive.value} title=${buttonTitle(goToTime)} aria-label="Time of the run: ${text}. Go to a time" onClick=${() => run(goToTime)}>${text}<//>
    <output id="measured" aria-live="off" aria-label="Measured speed">${measured ? `${measured.toFixed(measured < 1 ? 2 : measured < 100 ? 1 : 0)} x` : ""}</output>
  </div>`;
}
