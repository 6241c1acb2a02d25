import { html } from "../vendor/preact.js";

export const buffers = { id: "buffers", title: "Buffers", View: () => html`<p class="empty">Buffers</p>` };
