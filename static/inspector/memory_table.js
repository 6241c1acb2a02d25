// A memory as a table: chunks with their activations and the components of these, sorted as the user chooses.

import { html, useMemo, useState } from "../vendor/preact.js";
import { ChangeButtons } from "../changes/changes.js";
import { Button } from "../parts/button.js";
import { Chunk, chunkText, valueText } from "../parts/chunk.js";
import { chosen, notComputed, plotAll } from "../timeline/curves.js";
import { hidden } from "../timeline/rows.js";
import { fixed, Part, partName } from "./part_names.js";
import { Rows } from "./rows.js";

/** Returns the slots of a row that are shown, in the model's order: the slots that distinguish chunks mostly come first. */
function shownSlots({ slots }) {
  return Object.fromEntries(Object.entries(slots).filter(([name]) => !name.startsWith("_")));
}

/** Returns the sum of what is known of an activation. */
function knownSum({ parts }) {
  return Object.values(parts).reduce((sum, part) => sum + (typeof part === "number" ? part : 0), 0);
}

/** Returns rows in order; unknown values come last, unknown activations in the order of what is known of them. */
export function sorted(rows, { by, down }) {
  const value = (row) => (by === "chunk" ? chunkText(shownSlots(row)) : by === "activation" ? row.activation : row.parts[by]);
  const isKnown = (row) => value(row) !== null && value(row) !== undefined;
  const known = rows.filter(isKnown);
  const unknown = rows.filter((row) => !isKnown(row));
  const sign = down ? -1 : 1;
  known.sort((one, other) => sign * (typeof value(one) === "number" ? value(one) - value(other) : String(value(one)).localeCompare(String(value(other)), "en", { numeric: true })));
  if (by === "activation") unknown.sort((one, other) => sign * (knownSum(one) - knownSum(other)));
  return [...known, ...unknown];
}

function Head({ text, title, by, sort, onSort }) {
  const mine = sort.by === by;
  return html`<th class=${by === "chunk" ? "" : "number"} aria-sort=${mine ? (sort.down ? "descending" : "ascending") : "none"}>
    <button class="sort" title=${title} onClick=${() => onSort({ by, down: mine ? !sort.down : by !== "chunk" })}>${text}<span aria-hidden="true">${mine ? (sort.down ? " ▾" : " ▴") : ""}</span></button>
  </th>`;
}

/** Plots the activation of a chunk over time in the timeline, with its parts; or no longer. */
function PlotButton({ memory, chunk, plots }) {
  const curves = plots.curves.map((end) => `${memory}: ${chunk} ${end}`);
  const on = curves.length > 0 && curves.every((name) => chosen.value.includes(name));
  const reasons = [...new Set([plots.why, ...(on ? notComputed.value : [])])].filter(Boolean);
  const press = () => {
    plotAll(curves, !on);
    hidden.value = hidden.value.filter((group) => group !== "curves");
  };
  return html`<${Button} disabled=${curves.length === 0} aria-pressed=${on} title="Plot its activation and the parts of it over time, in the timeline" onClick=${press}>Plot<//>
    ${reasons.map((why) => html`<span key=${why} class="quiet">${why}</span>`)}`;
}

function Chosen({ memory, row, names, threshold, plots }) {
  const sum = row.activation === null ? "not known before a retrieval" : fixed(row.activation);
  return html`<section class="one-chunk" aria-label="The chosen chunk">
    <p class="mono">${Object.entries(row.slots).map(([slot, value]) => html`<span key=${slot} class="slot">${/^\d+$/.test(slot) ? null : html`<b>${slot}</b>`}${valueText(value)}</span>`)}</p>
    <p>
      Activation <b class="number">${sum}</b>
      ${names.length ? html`<span class="quiet"> = ${names.map((name, n) => html`${n ? " + " : ""}${partName(name)} <${Part} value=${row.parts[name]} />`)}</span>` : null}
      ${threshold !== null ? html`, threshold ${valueText(threshold)}` : null}
    </p>
    <p class="chunk-buttons"><${PlotButton} memory=${memory} chunk=${row.chunk} plots=${plots} /><${ChangeButtons} of="chunk" given=${{ memory, chunk: row.chunk }} /></p>
  </section>`;
}

/** @param answer The run's answer to `memory`. */
export function MemoryTable({ answer, words }) {
  const { rows, threshold, memory, plots } = answer;
  const [sort, setSort] = useState({ by: "activation", down: true });
  const key = `${memory} ${words}`;
  const [choice, setChoice] = useState({ key, chunk: null });
  const inHand = choice.key === key ? choice.chunk : null;
  const setChosen = (chunk) => setChoice({ key, chunk });
  const names = useMemo(() => [...new Set(rows.flatMap(({ parts }) => Object.keys(parts)))], [rows]);
  const all = useMemo(() => sorted(rows, sort), [rows, sort]);
  const at = all.findIndex(({ chunk }) => chunk === inHand);
  const under = ({ activation }) => threshold !== null && activation !== null && activation < threshold;
  const mark = sort.by === "activation" ? all.findIndex((row, n) => n > 0 && under(row) !== under(all[n - 1]) && row.activation !== null && all[n - 1].activation !== null) : -1;

  const row = (n, attributes) => html`<tr key=${all[n].chunk} ...${attributes} class="${under(all[n]) ? "under" : ""} ${n === mark ? "threshold" : ""} ${n === at ? "chosen" : ""}" title=${chunkText(shownSlots(all[n]))} onClick=${() => setChosen(n === at ? null : all[n].chunk)}>
    <td><${Chunk} chunk=${shownSlots(all[n])} /></td>
    <td class="number">${all[n].activation === null ? html`<span class="quiet" title="A part of the activation is computed only at a retrieval; the order is that of the other parts">?</span>` : html`<span title=${all[n].activation}>${fixed(all[n].activation)}</span>`}</td>
    ${names.map((name) => html`<td key=${name} class="number"><${Part} value=${all[n].parts[name]} /></td>`)}
  </tr>`;
  return html`<${Rows}
      id="chunks"
      label="Chunks of ${memory}"
      count=${all.length}
      row=${row}
      columns=${["auto", "98px", ...names.map(() => "100px")]}
      head=${html`<${Head} text="Chunk" by="chunk" sort=${sort} onSort=${setSort} /><${Head} text="Activation" by="activation" sort=${sort} onSort=${setSort} />
        ${names.map((name) => html`<${Head} key=${name} text=${partName(name)} title=${name} by=${name} sort=${sort} onSort=${setSort} />`)}`}
      chosen=${at < 0 ? null : at}
      onChoose=${(n) => setChosen(all[n].chunk)}
      empty=${html`<p class="empty">${words ? "No chunk has all of these words." : "This memory is still empty."}</p>`}
    />
    ${at < 0 ? null : html`<${Chosen} memory=${memory} row=${all[at]} names=${names} threshold=${threshold} plots=${plots} />`}`;
}
