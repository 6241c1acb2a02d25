// Save and run, and whether the run that is shown is one of the current text.

import { computed, html } from "../vendor/preact.js";
import { runModel } from "../bar/models.js";
import { sinceNow } from "../server.js";
import { notices, notify, session } from "../store.js";
import { documents, save, shown } from "./documents.js";
import { openTab } from "../open_tab.js";

/** Saves a text if necessary, and runs it from its start. */
export async function saveAndRun(document) {
  const wanted = sinceNow();
  if ((document.dirty.value || document.theirs.value) && !(await save(document))) return;
  if (!wanted()) return; // during the save, the user has chosen to show something else
  await runModel(document.path).catch((error) => notify(error.message));
}

/** Returns a notice if the run that is shown is not one of the file's text, or that text is not saved: {text, failed, gone, unsaved, path};
 * otherwise null. */
export const former = computed(() => {
  const facts = session.value;
  if (!facts || facts.recorded !== null) return null; // a recording is a run of the text of its time
  if (facts.gone) return { text: "The file of this run is gone from the folder: the run can go on, but cannot be restarted.", gone: true, path: facts.model };
  if (facts.loading) return null;
  if (!facts.stale) {
    const unsaved = documents.value.get(facts.model)?.dirty.value;
    return unsaved ? { text: "The text in the editor is not saved: runs are of the saved text.", unsaved, path: facts.model } : null;
  }
  // The newest attempt failed if it reported an error and is not the run that is shown.
  const failed = facts.attempt !== facts.shown_attempt && notices.value.some(({ level, attempt }) => level === "error" && attempt === facts.attempt);
  const text = `This run was made from an earlier version of the file${failed ? "; the new one cannot be loaded" : ""}.`;
  return { text, failed, path: facts.model };
});

/** Runs the new text of the file of the run that is shown. */
export function runNew(path) {
  const open = documents.value.get(path);
  return open ? saveAndRun(open) : runModel(path).catch((error) => notify(error.message));
}

/** Shows in the status line that the run is not one of the text in the editor, with a button to run that one. */
export function StaleRunNote() {
  const facts = former.value;
  // The editor shows this itself, beside the text.
  if (!facts || (openTab.value === "editor" && shown.value.path === facts.path)) return null;
  return html`<span class="former" role="status" title=${facts.text}>
    <span>${facts.text}</span>
    ${facts.gone ? null : html`<button onClick=${() => runNew(facts.path)}>${facts.unsaved ? "Save and run" : "Run the new one"}</button>`}
  </span>`;
}
