import { html } from "../vendor/preact.js";

export const Timeline = () => html`<p class="empty">Timeline</p>`;
