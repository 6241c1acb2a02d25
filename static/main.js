// Puts the page together.

import { html, render } from "./vendor/preact.js";
import { complain } from "./store.js";
import { Workbench } from "./workbench.js";

addEventListener("error", (event) => complain(`The page has a fault: ${event.message}`));
addEventListener("unhandledrejection", (event) => complain(`The page has a fault: ${event.reason?.message ?? event.reason}`));

render(html`<${Workbench} />`, document.body);
