// Explains why a production matches or not: condition by condition, and the components of its utility.

import { html } from "../vendor/preact.js";
import { ChangeButtons } from "../changes/changes.js";
import { valueText } from "../parts/chunk.js";
import { runStatus } from "../run_status.js";
import { statusOf } from "./production_list.js";
import { Part } from "./part_names.js";

const SIGNS = { true: ["✓", "holds"], false: ["✗", "does not hold"], null: ["?", "unknown here"] };

function ConditionRow({ one, first }) {
  const [sign, words] = SIGNS[one.holds];
  const at = one.condition.indexOf(": ");
  return html`<tr class="${one.holds === true ? "holds" : one.holds === false ? "fails" : "unknown"} ${first ? "first" : ""}">
    <td class="sign"><span role="img" aria-label=${words}>${sign}</span></td>
    <td class="mono"><span class="quiet">${one.condition.slice(0, at)}</span> ${one.condition.slice(at + 2)}</td>
    <td>
      ${one.holds === true
        ? html`<span class="mono">${one.found}</span>`
        : html`${one.holds === false ? html`expected <span class="mono">${one.expected}</span>, found <span class="mono">${one.found}</span>` : one.found}`}
      ${one.source ? html` <span class="quiet">(${one.source})</span>` : null}
    </td>
  </tr>`;
}

function Conditions({ reason }) {
  if (reason.conditions.length === 0) return html`<p class="quiet">It has no conditions: it always matches.</p>`;
  const failing = reason.conditions.findIndex(({ holds }) => holds !== true);
  return html`<table class="conditions" aria-label="Conditions of ${reason.name}">
    <thead>
      <tr><th><span class="unseen">Holds</span></th><th>Condition</th><th>Found</th></tr>
    </thead>
    <tbody>
      ${reason.conditions.map((one, n) => html`<${ConditionRow} key=${n} one=${one} first=${n === failing} />`)}
    </tbody>
  </table>`;
}

function Utility({ reason }) {
  const parts = Object.entries(reason.parts);
  const sum = reason.utility === null ? "unknown" : valueText(reason.utility);
  return html`<p class="utility">
    Utility <b class="number">${sum}</b>
    ${parts.length > 1 ? html`<span class="quiet"> = ${parts.map(([name, value], n) => html`${n > 0 ? " + " : ""}${name} <${Part} value=${value} />`)}</span>` : null}
  </p>`;
}

/** @param item An item of `productionsOf`; its reason is null before the run was asked. */
export function Why({ item }) {
  if (!item) return null;
  const { reason, name } = item;
  if (!reason) return runStatus.value.is === "running" ? html`<h3 class="mono">${name}</h3><p class="quiet">${runStatus.value.text}</p>` : null;
  const [kind, , words] = statusOf(reason);
  const bound = Object.entries(reason.bindings);
  return html`<h3 class=${kind}><span class="mono">${name}</span>: ${words}</h3>
    <p><${ChangeButtons} key=${`${item.system} ${name}`} of="production" given=${{ system: item.system, production: name }} /></p>
    ${reason.verdict ? html`<p>${reason.verdict}</p>` : null}
    <${Conditions} reason=${reason} />
    ${bound.length
      ? html`<p>
          <span class="quiet">Bound </span>
          ${bound.map(([variable, value]) => html`<span key=${variable} class="slot mono"><b>?${variable}</b>${value}</span>`)}
        </p>`
      : null}
    <${Utility} reason=${reason} />
    <p class="quiet">In ${reason.system}${reason.parents.length ? `; compiled from ${reason.parents.join(" and ")}` : ""}</p>`;
}
