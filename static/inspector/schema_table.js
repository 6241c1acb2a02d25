// The body schema: the postures that the agent knows, with the size of its body in each.

import { html } from "../vendor/preact.js";
import { valueText } from "../parts/chunk.js";

const FIRST = ["posture", "end", "extreme", "width", "depth", "height"];

/** Returns the rows of a memory that are postures. */
export function postures(rows) {
  return rows.filter(({ slots }) => "posture" in slots && "width" in slots);
}

/** @param rows The result of `postures`. */
export function SchemaTable({ rows }) {
  const joints = [...new Set(rows.flatMap(({ slots }) => Object.keys(slots)))].filter((name) => !FIRST.includes(name)).sort();
  return html`<div class="wide schema" tabindex="0" role="region" aria-label="Body schema">
    <table>
      <thead>
        <tr>
          <th>Posture</th><th>Ended</th><th>Extreme</th><th class="number">Width [m]</th><th class="number">Depth [m]</th><th class="number">Height [m]</th>
          ${joints.map((name) => html`<th key=${name} class="number" title="Angles in degrees, slides in metres">${name.replaceAll("_", " ")}</th>`)}
        </tr>
      </thead>
      <tbody>
        ${rows.map(
          ({ slots }, n) => html`<tr key=${n}>
            ${FIRST.slice(0, 3).map((name) => html`<td key=${name} class="mono">${valueText(slots[name])}</td>`)}
            ${FIRST.slice(3).map((name) => html`<td key=${name} class="number">${slots[name] === undefined ? "" : Number(slots[name]).toFixed(3)}</td>`)}
            ${joints.map((name) => html`<td key=${name} class="number">${slots[name] === undefined ? "" : valueText(slots[name])}</td>`)}
          </tr>`,
        )}
      </tbody>
    </table>
  </div>`;
}
