// A hint in the status line that a run in real time can go faster; shown until the user has changed a speed once.

import { html } from "../vendor/preact.js";
import { commandOf, run } from "../commands.js";
import { remembered } from "../local_storage.js";
import { isOver } from "../run_status.js";
import { bodies, state } from "../store.js";

/** Whether the user has ever changed the speed of a run. */
export const speedIsKnown = remembered("speed known", false);

export function Hint() {
  const hasBody = Object.keys(bodies.value).length > 0;
  if (speedIsKnown.value || !hasBody || isOver.value || state.value?.wanted !== 1) return null;
  return html`<button class="pace-hint" title="A model with a body goes at real time at first. + and -, or the choice of speeds above, change that" onClick=${() => run(commandOf("+"))}>Real time: press + to go faster</button>`;
}
