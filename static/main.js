// Assembles the page.

import { html, render } from "./vendor/preact.js";
import { notify } from "./store.js";
import { Workbench } from "./workbench.js";

const MAX_FAULTS = 10; // a fault repeated at each drawing would hide all other messages
const faults = new Set();

/** Reports an error of the page itself, once. */
function fault(text) {
  if (faults.has(text) || faults.size >= MAX_FAULTS) return;
  faults.add(text);
  const more = faults.size === MAX_FAULTS ? " There may be more, which are not shown. Reload the page; the run continues." : "";
  notify(`The page has a fault: ${text}${more}`);
}

// Nothing is wrong if a change of size causes another: the browser reports that one with the next picture.
addEventListener("error", (event) => event.message.startsWith("ResizeObserver loop") || fault(event.message));
addEventListener("unhandledrejection", (event) => fault(String(event.reason?.message ?? event.reason)));

render(html`<${Workbench} />`, document.body);
