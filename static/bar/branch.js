// Where a run continues differently: its previous future is kept as a branch, or the user is asked whether it may be lost.

import { html, signal, useEffect } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { confirmed } from "../parts/dialog.js";
import { remembered } from "../local_storage.js";
import { call, isLeft, say } from "../server.js";
import { complain, session, shownRecording } from "../store.js";
import { openRun } from "../runs/actions.js";
import { furthest, present, runTimeText } from "../timeline/seek.js";

/** Returns whether the server has a recording; it may have been deleted or renamed since it was opened. */
const isThere = (id) => call("GET", `/api/recordings/${id}`).then(() => true, () => false);

/** Sends a command that changes the run from a moment [s] on; if this is in its past and the run has no recording, asks first. Returns
 * whether it was sent; throws an Error with the reason if it cannot be done. */
export async function change(what, at = present.peek()) {
  const recording = shownRecording.peek();
  if (at > furthest.peek() - 1e-7 || (recording !== null && (await isThere(recording)))) return say(what).then(() => true);
  const [now, there, end] = [present.peek(), at, furthest.peek()].map((time) => runTimeText(time));
  const why = recording === null ? "It is not recorded" : "Its recording was deleted or renamed";
  const text = `The run is at ${now} and has reached ${end}. ${why}: if it is changed ${now === there ? "here" : `at ${there}`}, what came after ${there} is lost.`;
  if (!(await confirmed("Change the past?", text, "Change it, and lose the rest"))) return false;
  await say({ ...what, drop: true });
  return true;
}

/** Does the same, but shows an error among the messages. */
export function orderChange(what) {
  return change(what).catch((error) => isLeft(error) || complain(error.message));
}

const MAX_SHOWN = 50; // the number of notices remembered

/** The notices that were shown: they do not return when the page is loaded again. */
const alreadyShown = remembered("branches shown", []);
/** The notices that are closed: dismissed now, or shown before the page was loaded. */
const closed = signal(alreadyShown.peek());

function Notice({ which, title, children }) {
  useEffect(() => {
    if (!alreadyShown.newest().includes(which)) alreadyShown.value = [...alreadyShown.newest(), which].slice(-MAX_SHOWN);
  }, [which]);
  return html`<span class="former branched" role="status" title=${title}>
    <span>${children}</span>
    <${Button} class="bare" aria-label="Dismiss" title="Dismiss; the recording stays in Runs" onClick=${() => (closed.value = [...closed.value, which])}>✕<//>
  </span>`;
}

/** Shows in the status line what was kept when the run was changed in its past. */
export function Branch() {
  const { id, born, branched, model } = session.value ?? {};
  if (!branched) return null;
  const { recording, opened, at, until, made, kept } = branched;
  const which = `${id} ${born} ${recording}`;
  if (!kept || closed.value.includes(which)) return null;
  const where = `the recording ${recording}, which is listed in Runs`;
  const open = () => openRun({ id: recording, model, made });
  if (opened) {
    const title = `From ${runTimeText(at)} on it differs from ${where}, or goes beyond it; this is recorded as a branch.`;
    return html`<${Notice} key=${which} which=${which} title=${title}>
      <button class="link" onClick=${open}>The recording</button> keeps the run up to ${runTimeText(until)}
    <//>`;
  }
  return html`<${Notice} key=${which} which=${which} title="Changed at ${runTimeText(at)}; the original continuation is kept as ${where}">
    The run up to ${runTimeText(until)} is kept as <button class="link" onClick=${open}>a branch</button>
  <//>`;
}
