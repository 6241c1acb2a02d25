import { html } from "../vendor/preact.js";

export const parameters = { id: "parameters", title: "Parameters", View: () => html`<p class="empty">Parameters</p>` };
