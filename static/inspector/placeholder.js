// Placeholder for an answer that is not available: shows why, or that it takes a while.

import { html } from "../vendor/preact.js";
import { isGone, runStatus } from "../run_status.js";

/** @param answer The result of `useAnswer`. */
export function Placeholder({ answer }) {
  const { is, text } = runStatus.value;
  if (isGone.value) return html`<p class="empty">${text}</p>`;
  if (is === "busy" || is === "halted") return html`<p class="late" role="status">${text}</p>`;
  if (answer.error) return html`<p class="trouble" role="alert">${answer.error}</p>`;
  return answer.waiting ? html`<p class="late" role="status">Asking the run …</p>` : null;
}
