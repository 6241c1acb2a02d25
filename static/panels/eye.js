// What an eye sees: the retina, and the dictionary of edges behind it as a table.

import { html, useSignal } from "../vendor/preact.js";
import { shadeOf } from "../eye/drawing.js";
import { Retina } from "../eye/retina.js";
import { Waiting } from "../mind/waiting.js";
import { useAnswer } from "../parts/answer.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { isGone, nothing } from "../standing.js";
import { complain, session } from "../store.js";
import { dark } from "../theme.js";

const MOST_ROWS = 400;
const KINDS = [["objects", "Objects"], ["edges", "Edges"]];

/** Returns the bodies of the run that have an eye. */
export function seeing() {
  return Object.entries(session.value?.world?.bodies ?? {}).filter(([, { eye: name }]) => name).map(([body]) => body);
}

/** Sums a view up by label: {label, extents, rows, left, right, nearest}. */
function objectsOf({ extents }) {
  const found = new Map();
  for (const [row, label, , x1, x2, d1, d2] of extents) {
    const one = found.get(label) ?? { label, extents: 0, top: row, bottom: row, left: x1, right: x2, nearest: Infinity };
    one.extents += 1;
    one.top = Math.min(one.top, row);
    one.bottom = Math.max(one.bottom, row);
    one.left = Math.min(one.left, x1);
    one.right = Math.max(one.right, x2);
    one.nearest = Math.min(one.nearest, d1, d2);
    found.set(label, one);
  }
  return [...found.values()].sort((one, other) => one.nearest - other.nearest);
}

function Swatch({ label, distance }) {
  return html`<span class="swatch" style=${{ background: shadeOf(label, distance, dark.value) }}></span>`;
}

function Objects({ view }) {
  return html`<table>
    <thead><tr><th>label</th><th class="number">nearest [m]</th><th class="number">x from</th><th class="number">to</th><th class="number">rows</th><th class="number">extents</th></tr></thead>
    <tbody>
      ${objectsOf(view).map(
        (one) => html`<tr key=${one.label}>
          <td><${Swatch} label=${one.label} distance=${one.nearest} />${one.label}</td>
          <td class="number">${one.nearest.toFixed(2)}</td>
          <td class="number">${one.left.toFixed(3)}</td>
          <td class="number">${one.right.toFixed(3)}</td>
          <td class="number">${one.top}–${one.bottom}</td>
          <td class="number">${one.extents}</td>
        </tr>`,
      )}
    </tbody>
  </table>`;
}

function Edges({ view }) {
  const units = { d1: " [m]", d2: " [m]", a1: " [°]", a2: " [°]" };
  const digits = { row: 0, label: 0, d1: 2, d2: 2, a1: 1, a2: 1 };
  const rest = view.extents.length - MOST_ROWS;
  return html`<table>
      <thead><tr>${view.fields.map((field) => html`<th class="number" key=${field}>${field}${units[field] ?? ""}</th>`)}</tr></thead>
      <tbody>
        ${view.extents.slice(0, MOST_ROWS).map((extent, n) => html`<tr key=${n}>${extent.map((value, at) => html`<td class="number">${value.toFixed(digits[view.fields[at]] ?? 3)}</td>`)}</tr>`)}
      </tbody>
    </table>
    ${rest > 0 ? html`<p class="empty">${rest} more; «Copy as JSON» has all.</p>` : null}`;
}

async function copy(view) {
  try {
    await navigator.clipboard.writeText(JSON.stringify(view));
    complain(`${counted(view.extents.length, "extent is", "extents are")} on the clipboard.`, "info");
  } catch {
    complain("The browser does not let the page write to the clipboard.");
  }
}

function Eye() {
  const bodies = seeing();
  const body = useSignal(null);
  const kind = useSignal("objects");
  const of = bodies.includes(body.value) ? body.value : bodies[0];
  const told = useAnswer(of === undefined ? null : { type: "view", body: of }, { live: true });
  const { answer } = told;
  if (of === undefined) return html`<p class="empty">${nothing("No body of this model has an eye. What one sees is shown here as soon as a model with a camera runs.")}</p>`;
  const Table = kind.value === "objects" ? Objects : Edges;
  return html`<div class="eye">
    <div class="tools">
      ${bodies.length > 1 ? html`<select aria-label="Whose eye" value=${of} onChange=${(event) => (body.value = event.currentTarget.value)}>${bodies.map((name) => html`<option>${name}</option>`)}</select>` : html`<b>eye of ${of}</b>`}
      <span class="stretch"></span>
      ${KINDS.map(([id, text]) => html`<button key=${id} aria-pressed=${kind.value === id} onClick=${() => (kind.value = id)}>${text}</button>`)}
      <button disabled=${!answer} onClick=${() => copy(answer)}><${Icon} name="copy" />Copy as JSON</button>
    </div>
    <${Waiting} told=${told} />
    ${isGone.value && !answer ? null : html`<${Retina} view=${answer} />`}
    <div class="eye-table" tabindex="0" role="region" aria-label="What is seen, as a table">${answer?.extents.length ? html`<${Table} view=${answer} />` : null}</div>
  </div>`;
}

export const eye = { id: "eye", title: "Eye", View: Eye };
