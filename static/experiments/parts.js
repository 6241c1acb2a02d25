// The choice of what is shown of an experiment.

import { html } from "../vendor/preact.js";
import { part } from "./list.js";

const PARTS = [["figure", "Figure"], ["trials", "Trials"], ["about", "Design"], ["report", "Report"]];

export function Parts({ experiment }) {
  const all = PARTS.filter(([id]) => id !== "report" || experiment.report);
  return html`<span class="choices" role="group" aria-label="What is shown">
    ${all.map(([id, text]) => html`<button key=${id} aria-pressed=${part.value === id} onClick=${() => (part.value = id)}>${text}</button>`)}
  </span>`;
}
