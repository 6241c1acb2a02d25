// «Go to a time»: asks for a time that the run has reached, and goes there.

import { html, signal } from "../vendor/preact.js";
import { command } from "../commands.js";
import { dialog } from "../parts/dialog.js";
import { Problem } from "../parts/problem.js";
import { plainTime, TIMES, timeOfText } from "../parts/units.js";
import { runStatus } from "../run_status.js";
import { alive } from "../store.js";
import { furthest, isBeyond, present, runTimeText, seek } from "./seek.js";

const text = signal("");
/** Why the run cannot go there; null if it can. */
const problem = signal(null);

/** Returns the problem with the text; null if there is none. */
function wrong() {
  const time = timeOfText(text.value);
  if (!(time >= 0)) return `Time: must be a time, such as ${TIMES} (got '${text.value}')`;
  return isBeyond(time) ? `Time: the run has only reached ${runTimeText(furthest.peek())}; «Run until …» goes on to a later time (got ${text.value})` : null;
}

function Body() {
  return html`<label class="field">
      Time, from 0 to ${runTimeText(furthest.value)}
      <input data-first inputmode="decimal" spellcheck=${false} aria-invalid=${Boolean(problem.value)} value=${text.value} onInput=${(event) => (text.value = event.currentTarget.value)} />
    </label>
    <${Problem} text=${problem.value} />`;
}

async function ask() {
  text.value = plainTime(present.peek(), 2, furthest.peek());
  problem.value = null;
  const check = () => {
    problem.value = wrong();
    return problem.value === null;
  };
  if (await dialog({ title: "Go to a time", body: html`<${Body} />`, actions: [{ text: "Go there", kind: "primary" }], check })) seek(timeOfText(text.value));
}

/** The command that opens it. */
export const goToTime = command({ text: "Go to a time …", key: "g", group: "Timeline", work: ask, ready: () => alive.value, why: () => runStatus.value.text });
