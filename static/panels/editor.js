import { html } from "../vendor/preact.js";

export const editor = { id: "editor", title: "Editor", View: () => html`<p class="empty">Editor</p>` };
