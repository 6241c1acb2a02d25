// Where a run continues differently: its previous future is kept as a branch, or the user is asked whether it may be lost.

import { html, signal, useEffect } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { confirmed } from "../parts/dialog.js";
import { remembered } from "../local_storage.js";
import { isLeft, request } from "../server.js";
import { notify, session } from "../store.js";
import { openRun } from "../runs/actions.js";
import { runTimeText } from "../timeline/seek.js";
import { embedded } from "../address.js";

/** Sends a command that changes the run; if what lies ahead would be lost, asks whether it may be. Returns whether the run was changed;
 * throws an Error with the reason if it cannot be. */
export async function change(what) {
  try {
    await request(what);
  } catch (error) {
    if (!error.loses) throw error;
    const text = `${error.message[0].toUpperCase()}${error.message.slice(1)}.`;
    if (!(await confirmed("Change the past?", text, "Change it anyway"))) return false;
    await request({ ...what, drop: true });
  }
  return true;
}

/** Does the same, but shows an error among the messages. */
export function sendChange(what) {
  return change(what).catch((error) => isLeft(error) || notify(error.message));
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
    <${Button} class="bare" aria-label="Dismiss" title=${embedded === null ? "Dismiss; the recording stays in Runs" : "Dismiss"} onClick=${() => (closed.value = [...closed.value, which])}>✕<//>
  </span>`;
}

/** Shows in the status line what was kept when the run was changed in its past. */
export function Branch() {
  const { id, born, branched, model, recording: own } = session.value ?? {};
  if (!branched) return null;
  const { recording, opened, at, until, made, kept } = branched;
  const which = `${id} ${born} ${recording}`;
  if (!kept || closed.value.includes(which)) return null;
  const where = `the recording ${recording}, which is listed in Runs`;
  if (embedded !== null) {
    const text = "A branch, which ends with the kernel; run the cell again to see the recording";
    const title = `${text}. From ${runTimeText(at)} on, this differs from the recording, or goes beyond it.`; // a narrow page cuts the text
    return html`<${Notice} key=${which} which=${which} title=${title}>${text}<//>`;
  }
  const open = () => openRun({ id: recording, model, made });
  if (opened) {
    const title = `From ${runTimeText(at)} on it differs from ${where}, or goes beyond it; this is ${own === null ? "not recorded" : "recorded as a branch"}.`;
    return html`<${Notice} key=${which} which=${which} title=${title}>
      <button class="link" onClick=${open}>The recording</button> keeps the run up to ${runTimeText(until)}
    <//>`;
  }
  return html`<${Notice} key=${which} which=${which} title="Changed at ${runTimeText(at)}; the original continuation is kept as ${where}">
    The run up to ${runTimeText(until)} is kept as <button class="link" onClick=${open}>a branch</button>
  <//>`;
}
