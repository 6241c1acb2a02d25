import { html } from "../vendor/preact.js";

export const eye = { id: "eye", title: "Eye", View: () => html`<p class="empty">Eye</p>` };
