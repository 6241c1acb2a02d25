// What has gone wrong, shown beside what was tried.

import { html } from "../vendor/preact.js";
import { Inline } from "./prose.js";

/** @param text What is wrong; null or empty for nothing. @param id For the `aria-describedby` of what it is about. */
export function Problem({ text, id }) {
  return text ? html`<p class="problem bad" role="alert" id=${id}><${Inline} text=${text} /></p>` : null;
}
