// The measured result of a finished run, formatted for users.

import { html } from "../vendor/preact.js";

/** Units by the ending of a name: [ending, unit, decimals, factor]. */
const UNITS = [
  ["_m_s", "m/s", 2],
  ["_n_s", "N s", 1],
  ["_deg", "°", 1],
  ["_rad", "°", 1, 180 / Math.PI],
  ["_m", "m", 3],
  ["_cm", "cm", 1],
  ["_s", "s", 2],
  ["_n", "N", 1],
  ["_kg", "kg", 2],
];

/** Returns the label of a number of a result, and its text with its unit. */
export function measured(name, value) {
  const [ending, unit, digits, factor = 1] = UNITS.find(([one]) => name.endsWith(one)) ?? ["", "", 4];
  const bare = name.slice(0, name.length - ending.length).replaceAll("_", " ");
  const label = bare.charAt(0).toUpperCase() + bare.slice(1);
  if (value === null) return [label, "none", ""];
  if (typeof value !== "number") return [label, typeof value === "object" ? JSON.stringify(value) : String(value), ""];
  const text = Number.isInteger(value) && ending === "" ? String(value) : (value * factor).toFixed(digits);
  return [label, text, unit];
}

export function Result({ result }) {
  const { outcome, ...rest } = result;
  return html`<section class="result" aria-label="Result">
    <h3>Result${outcome === undefined ? "" : ": "}<b class="outcome ${outcome}">${outcome ?? ""}</b></h3>
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
