// A banner between the text and its problems for decisions: the file has changed, or the run is not one of this text.

import { confirmed } from "../parts/dialog.js";
import { html } from "../vendor/preact.js";
import { close, save } from "./documents.js";
import { former, runNew } from "./stale_run.js";

/** Closes a text whose file is gone, after asking. */
async function leave({ path }) {
  const text = "Its file is gone from the folder: this text is the only copy. It is lost, with what is not saved.";
  if (await confirmed(`Close ${path}?`, text, "Close, and lose the text")) close(path);
}

/** @param document The text that is shown. @param compare Shows both texts if the file has another one. */
export function FileBanner({ document, compare }) {
  const theirs = document.theirs.value;
  const run = former.value;
  if (theirs?.text === null) {
    return html`<div class="strip bad" role="alert">
      <span>The file is gone from the folder.</span>
      <button onClick=${() => save(document)}>Save it again</button>
      <button onClick=${() => leave(document)}>Close</button>
    </div>`;
  }
  if (theirs) {
    return html`<div class="strip bad" role="alert">
      <span>The file has changed on disk.</span>
      <button onClick=${compare}>Compare and choose</button>
    </div>`;
  }
  if (!run || run.path !== document.path) return null;
  return html`<div class="strip" role="status">
    <span>${run.text}</span>
    ${run.gone || run.unsaved ? null : html`<button onClick=${() => runNew(run.path)}>Run the new one</button>`}
  </div>`;
}
