import { html } from "../vendor/preact.js";

export const productions = { id: "productions", title: "Productions", View: () => html`<p class="empty">Productions</p>` };
