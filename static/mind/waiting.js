// Placeholder for an answer that is not available: shows why, or that it takes a while.

import { html } from "../vendor/preact.js";
import { isGone, standing } from "../standing.js";

/** @param told The result of `useAnswer`. */
export function Waiting({ told }) {
  const { is, text } = standing.value;
  if (isGone.value) return html`<p class="empty">${text}</p>`;
  if (is === "busy" || is === "halted") return html`<p class="late" role="status">${text}</p>`;
  if (told.error) return html`<p class="trouble" role="alert">${told.error}</p>`;
  return told.waiting ? html`<p class="late" role="status">Asking the run …</p>` : null;
}
