// The table of trials of an experiment, page by page; a row opens its trial in the 3D view.

import { html, useEffect, useSignal } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { usePolled } from "./polling.js";
import { isOpen, openTrial, pathOf, waitOf, where } from "./list.js";
import { cellText, columnText, headText } from "./wording.js";

const PAGE = 50; // rows
const NUMBERS = ["integer", "real"];

/** Returns the columns that are shown: those that differ between trials in the design, and the measures. */
function shownOf(columns, facts) {
  const isShown = ({ name, role }) =>
    role === "measure" || ["trial", "participant", "end", "wall_s"].includes(name) || name in (facts.factors ?? {}) || (role === "value" && !facts.factors);
  const last = (name) => (name === "end" ? 1 : name === "wall_s" ? 2 : 0);
  return columns.filter(isShown).toSorted((one, other) => last(one.name) - last(other.name));
}

function Head({ column, sort, onSort }) {
  const here = sort.by === column.name;
  return html`<th scope="col" class=${NUMBERS.includes(column.type) ? "number" : ""} aria-sort=${here ? (sort.down ? "descending" : "ascending") : "none"} title=${column.meaning}>
    <button class="bare" aria-label="Sort by ${column.name}" onClick=${onSort}>${headText(column)}<span class="arrow" aria-hidden="true">${here ? (sort.down ? "▾" : "▴") : ""}</span></button>
  </th>`;
}

function Cell({ column, row, facts }) {
  const value = row[column.name];
  if (column.name === "end" && row.error) return html`<td class="bad" title=${row.error}>${row.end}: <span class="mono">${row.error.trim().split("\n").at(-1)}</span></td>`;
  if (column.name === "wall_s") return html`<td class="number quiet">${value === null ? "" : value.toFixed(2)}</td>`;
  return html`<td class=${NUMBERS.includes(column.type) ? "number" : ""}>${value === null || value === undefined ? "" : cellText(column.name, value, facts)}</td>`;
}

function Row({ experiment, facts, columns, row }) {
  const waits = waitOf(experiment.id) !== null;
  const open = () => openTrial(experiment.id, row.trial);
  const isShown = isOpen(experiment.id, row.trial);
  return html`<tr class=${`${waits ? "" : "opens"} ${isShown ? "chosen" : ""}`} aria-current=${isShown} title=${waits ? null : "Open this trial in the 3D view"} onClick=${waits ? null : open}>
    ${columns.map((column) =>
      column.name === "trial"
        ? html`<td key="trial" class="number"><button class="link" aria-disabled=${waits} aria-label="Open trial ${row.trial}" onClick=${(event) => (event.stopPropagation(), open())}>${row.trial}</button></td>`
        : html`<${Cell} key=${column.name} column=${column} row=${row} facts=${facts} />`,
    )}
  </tr>`;
}

function Filter({ facts }) {
  const names = Object.entries(where.value);
  const drop = (name) => (where.value = Object.fromEntries(names.filter(([other]) => other !== name)));
  return names.map(([name, value]) => html`<button key=${name} class="filter" title="Show trials with any ${name}" aria-label="Any ${name}" onClick=${() => drop(name)}>${columnText(name)} ${cellText(name, value, facts)} <${Icon} name="close" /></button>`);
}

/** @param experiment The summary of the experiment. @param facts Its facts. */
export function Trials({ experiment, facts }) {
  const sort = useSignal({ by: "trial", down: false });
  const first = useSignal(0);
  const failed = useSignal(false);
  const conditions = JSON.stringify(where.value);
  useEffect(() => void (first.value = 0), [conditions, sort.value, failed.value, experiment.id]);
  const query = new URLSearchParams({ first: first.value, most: PAGE, where: conditions, sort: sort.value.by, down: sort.value.down, failed: failed.value });
  const { answer, error, waiting } = usePolled(`${pathOf(experiment.id)}/rows?${query}`, experiment.done);
  const columns = answer ? shownOf(answer.columns, facts) : [];
  const sortBy = ({ name, type }) => () => (sort.value = { by: name, down: sort.value.by === name ? !sort.value.down : name !== "trial" && NUMBERS.includes(type) });
  const last = answer ? Math.min(answer.total, answer.first + PAGE) : 0;
  return html`
    <div class="menus">
      <${Filter} facts=${facts} />
      ${experiment.failures > 0 || failed.value ? html`<label><input type="checkbox" checked=${failed.value} onChange=${(event) => (failed.value = event.currentTarget.checked)} /> failed only</label>` : null}
      <span class="pages">
        ${answer ? html`<span class="number quiet" role="status">${answer.total === 0 ? "no trials" : `${(answer.first + 1).toLocaleString("en")}–${last.toLocaleString("en")} of ${counted(answer.total, "trial")}`}</span>` : null}
        ${answer && answer.total > PAGE
          ? html`<span class="choices">
              <${Button} aria-label="Previous page" title="Previous page" disabled=${answer.first === 0} onClick=${() => (first.value = Math.max(0, answer.first - PAGE))}><span class="back"><${Icon} name="right" /></span><//>
              <${Button} aria-label="Next page" title="Next page" disabled=${last >= answer.total} onClick=${() => (first.value = answer.first + PAGE)}><${Icon} name="right" /><//>
            </span>`
          : null}
      </span>
    </div>
    <div class="part">
      <${Problem} text=${error && `The trials cannot be read: ${error}`} />
      <div class="trials" aria-busy=${waiting}>
        ${answer?.rows.length > 0
          ? html`<table aria-label="Trials">
              <thead><tr>${columns.map((column) => html`<${Head} key=${column.name} column=${column} sort=${sort.value} onSort=${sortBy(column)} />`)}</tr></thead>
              <tbody>${answer.rows.map((row) => html`<${Row} key=${row.trial} experiment=${experiment} facts=${facts} columns=${columns} row=${row} />`)}</tbody>
            </table>`
          : html`<p class="empty">${answer ? "No finished trial." : error ? "" : html`<progress aria-label="Reading"></progress> Reading the trials …`}</p>`}
      </div>
    </div>
  `;
}
