// What stands in the place of an answer that is not there: why not, or that it takes a while.

import { html } from "../vendor/preact.js";
import { alive, session } from "../store.js";

/** @param told What `useAnswer` returns. */
export function Waiting({ told }) {
  const { stuck, loading } = session.value ?? {};
  if (!alive.value) {
    return html`<p class="empty">${loading ? "The model is being loaded …" : "No run to look at. Restart it, or choose a model above."}</p>`;
  }
  if (stuck) return html`<p class="late" role="status">The model is busy${stuck.line ? ` at line ${stuck.line}` : ""}; it answers after this step. Stop ends it.</p>`;
  if (told.error) return html`<p class="trouble" role="alert">${told.error}</p>`;
  return told.waiting ? html`<p class="late" role="status">Asking the run …</p>` : null;
}
