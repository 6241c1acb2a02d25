// Links to the manual, which the workbench serves at /manual/.

import { html } from "../vendor/preact.js";
import { Icon } from "./icon.js";

/** A link to a panel's page in the manual; `page` is the panel's id. */
export function ManualLink({ page, title }) {
  const text = `Manual: ${title}`;
  return html`<a class="manual-link" href="/manual/workbench/${page}/" target="_blank" rel="noopener" title=${text} aria-label=${text}><${Icon} name="book" /></a>`;
}
