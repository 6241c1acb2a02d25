import { html } from "../vendor/preact.js";

export const memory = { id: "memory", title: "Memory", View: () => html`<p class="empty">Memory</p>` };
