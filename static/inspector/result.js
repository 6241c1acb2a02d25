// The measured result of a finished run, formatted for users.

import { measuredText, unitOf } from "../parts/units.js";
import { html } from "../vendor/preact.js";

/** Returns the label of a number of a result, and its text with its unit. */
function measured(name, value) {
  const { label: bare, unit } = unitOf(name);
  const label = bare.charAt(0).toUpperCase() + bare.slice(1);
  if (value === null) return [label, "none", ""];
  if (typeof value !== "number") return [label, typeof value === "object" ? JSON.stringify(value) : String(value), ""];
  return [label, measuredText(name, value), unit];
}

export function Result({ result }) {
  const { outcome, ...rest } = result;
  return html`<section class="result" aria-label="Result">
    <h2>Result${outcome === undefined ? "" : ": "}<b class="outcome ${outcome}">${outcome ?? ""}</b></h2>
    <dl>
      ${Object.entries(rest).map(([name, value]) => {
        const [label, text, unit] = measured(name, value);
        return html`<div key=${name} title=${name}>
          <dt>${label}</dt>
          <dd class="number ${value === null ? "quiet" : ""}">${text}</dd>
          <dd class="unit quiet">${unit}</dd>
        </div>`;
      })}
    </dl>
  </section>`;
}
