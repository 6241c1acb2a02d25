// What has gone wrong, shown beside what was tried.

import { html } from "../vendor/preact.js";

/** @param text What is wrong; null or empty for nothing. */
export function Problem({ text }) {
  return text ? html`<p class="problem bad" role="alert">${text}</p>` : null;
}
