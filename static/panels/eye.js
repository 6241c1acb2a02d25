// What an eye sees: the retina, and the dictionary of edges behind it as a table.

import { html, useSignal } from "../vendor/preact.js";
import { shadeOf } from "../eye/drawing.js";
import { bodiesWithEye } from "../eye/inset.js";
import { Retina } from "../eye/retina.js";
import { Placeholder } from "../inspector/placeholder.js";
import { useAnswer } from "../parts/answer.js";
import { CopyButton } from "../parts/copy.js";
import { nameWithUnit } from "../parts/units.js";
import { isGone, nothing } from "../run_status.js";
import { dark } from "../theme.js";

const MAX_ROWS = 400;
const KINDS = [["objects", "Objects"], ["edges", "Edges"]];

/** Returns a summary of a view by label: {label, extents, rows, left, right, nearest}. */
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

function Swatch({ colour, distance }) {
  return html`<span class="swatch" style=${{ background: shadeOf(colour, distance, dark.value) }}></span>`;
}

/** The objects in view; the one under the pointer is framed in the picture, as several may have one colour. */
function Objects({ view, pointed }) {
  return html`<table>
    <thead><tr><th>label</th><th class="number">nearest [m]</th>${["left", "right"].map((edge) => html`<th class="number" key=${edge} title="Where its ${edge} edge is in the picture: 0 at the left, 1 at the right">${edge} edge [0–1]</th>`)}<th class="number">rows</th><th class="number" title="Stretches of a row in which it is seen">extents</th></tr></thead>
    <tbody>
      ${objectsOf(view).map(
        (one) => html`<tr key=${one.label} onPointerEnter=${() => (pointed.value = one.label)} onPointerLeave=${() => (pointed.value = null)}>
          <td><${Swatch} colour=${view.colours[one.label]} distance=${one.nearest} />${one.label}</td>
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

const DIGITS = { m: 2, "°": 1 }; // decimals, by unit

/** The descriptions of the columns of edges, as the camera documents its fields. */
function Legend({ fields }) {
  return html`<details class="legend">
    <summary>What the columns mean</summary>
    <dl>${fields.map((field) => html`<div key=${field.name}><dt class="mono">${nameWithUnit(field.name, field.unit)}</dt><dd><b>${field.title}</b>: ${field.about}</dd></div>`)}</dl>
  </details>`;
}

function Edges({ view }) {
  const text = (value, at) => (Number.isInteger(value) && at < 2 ? String(value) : value.toFixed(DIGITS[view.fields[at].unit] ?? 3));
  const rest = view.extents.length - MAX_ROWS;
  return html`<${Legend} fields=${view.fields} />
    <table aria-label="Edges">
      <thead><tr>${view.fields.map((field) => html`<th class="number" key=${field.name} title=${nameWithUnit(`${field.title}: ${field.about}`, field.unit)}>${nameWithUnit(field.name, field.unit)}</th>`)}</tr></thead>
      <tbody>
        ${view.extents.slice(0, MAX_ROWS).map((extent, n) => html`<tr key=${n}>${extent.map((value, at) => html`<td class="number">${text(value, at)}</td>`)}</tr>`)}
      </tbody>
    </table>
    ${rest > 0 ? html`<p class="empty">${rest} more; «Copy as JSON» has all.</p>` : null}`;
}

function Eye() {
  const bodies = bodiesWithEye();
  const body = useSignal(null);
  const kind = useSignal("objects");
  const pointed = useSignal(null); // the label under the pointer
  const of = bodies.includes(body.value) ? body.value : bodies[0];
  const result = useAnswer(of === undefined ? null : { type: "view", body: of }, { live: true });
  const { answer } = result;
  if (of === undefined) return html`<p class="empty">${nothing("No body of this model has an eye. What one sees is shown here as soon as a model with a camera runs.")}</p>`;
  const Table = kind.value === "objects" ? Objects : Edges;
  return html`<div class="eye">
    <div class="tools">
      ${bodies.length > 1 ? html`<select aria-label="Whose eye" value=${of} onChange=${(event) => (body.value = event.currentTarget.value)}>${bodies.map((name) => html`<option>${name}</option>`)}</select>` : html`<b>eye of ${of}</b>`}
      <span class="stretch"></span>
      ${KINDS.map(([id, text]) => html`<button key=${id} aria-pressed=${kind.value === id} onClick=${() => (kind.value = id)}>${text}</button>`)}
      <${CopyButton} text="Copy as JSON" disabled=${!answer} copied=${() => JSON.stringify(answer)} />
    </div>
    <${Placeholder} answer=${result} />
    ${isGone.value && !answer ? null : html`<${Retina} view=${answer} pointed=${pointed.value} />`}
    <div class="eye-table" tabindex="0" role="region" aria-label="What is seen, as a table">${answer?.extents.length ? html`<${Table} view=${answer} pointed=${pointed} />` : null}</div>
  </div>`;
}

export const panel = { id: "eye", title: "Eye", order: 5, View: Eye };
