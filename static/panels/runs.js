import { html } from "../vendor/preact.js";

export const runs = { id: "runs", title: "Runs", View: () => html`<p class="empty">Runs</p>` };
