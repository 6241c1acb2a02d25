// The conflict set: the productions that matched in the last cycle, with utilities, and the chosen one.

import { html, useMemo } from "../vendor/preact.js";
import { useAnswer } from "../parts/answer.js";
import { chosenText, isGone, nothingYet } from "../run_status.js";
import { eventCount, running, state } from "../store.js";
import { agentOf, agentsOf } from "./agents.js";
import { at, explainProduction } from "./explanation.js";
import { eventMomentText, pairs } from "./event_text.js";
import { fixed } from "./part_names.js";
import { eventAt, useEventFilter } from "./event_filter.js";

const isChoice = ([, , kind, data]) => kind === "select" || kind === "fire" || kind === "changed" || (kind === "conflict" && Object.keys(data.utilities).length > 0);

/** Returns the last cycle of each system before an event: {time, conflict, select, fire, over}, as far as it got. */
function lastCycles(filtered, end, time) {
  const cycles = new Map();
  const after = new Map(); // the events after the conflict, by system
  const last = filtered.below(end) - 1;
  for (let n = last; n >= 0 && n > last - 1999; n -= 1) {
    const [when, source, kind, data] = eventAt(filtered.numbers[n]);
    if (cycles.has(source) || (time !== null && when > time)) continue;
    if (kind === "conflict") cycles.set(source, { source, time: when, conflict: data, ...after.get(source) });
    else after.set(source, { ...after.get(source), [kind]: { time: when, ...data } });
  }
  return [...cycles.values()];
}

function comesOf({ select, fire, changed, conflict }) {
  if (fire) return html`<b class="mono">${fire.production}</b> fired at ${eventMomentText(fire.time)}`;
  if (changed) return html`<b class="mono">${changed.production}</b> was chosen, but no longer matched at ${eventMomentText(changed.time)}`;
  if (select) return html`<b class="mono">${select.production}</b> ${chosenText(at.value === null)}`;
  return conflict.threshold === undefined ? "nothing is chosen yet" : "none reaches the threshold";
}

function rowsOf({ conflict, select, fire }) {
  const names = [...new Set(Object.values(conflict.parts ?? {}).flatMap(Object.keys))];
  const chosen = select?.production ?? fire?.production;
  const rows = Object.entries(conflict.utilities)
    .map(([name, utility]) => {
      const parts = conflict.parts?.[name] ?? {};
      const base = utility - Object.values(parts).reduce((sum, value) => sum + value, 0);
      return { name, utility, base, parts, chosen: name === chosen };
    })
    .toSorted((one, other) => other.utility - one.utility || other.chosen - one.chosen);
  return { names, rows, own: names.includes("get_activation") };
}

function Cycle({ cycle, agents }) {
  const { source, time, conflict, fire } = cycle;
  const asks = running.value ? null : { type: "explain", at: time / 1e6, agent: agentOf(source, agents) ?? source };
  const { answer } = useAnswer(asks);
  const reasons = useMemo(() => new Map((answer?.[0].time === time / 1e6 ? answer[0].productions : []).filter(({ system }) => system === source).map((reason) => [reason.name, reason])), [answer, time]);
  const { names, rows, own } = rowsOf(cycle);
  const bound = (name) => (fire?.production === name ? pairs(fire.bound) : pairs(reasons.get(name)?.bindings));
  return html`<section aria-label="Conflict set of ${source}">
    <h3>${source} <span class="quiet">at ${eventMomentText(time)}:</span> ${rows.length} matched, ${comesOf(cycle)}</h3>
    <div class="wide">
      <table class="conflict">
        <thead>
          <tr>
            <th><span class="unseen">Chosen</span></th><th>Production</th><th class="number">Utility</th>
            ${names.length && !own ? html`<th class="number">base</th>` : null}
            ${names.map((name) => html`<th key=${name} class="number" title=${conflict.drawn?.includes(name) ? "Drawn at random" : ""}>${name}${conflict.drawn?.includes(name) ? " (noise)" : ""}</th>`)}
            <th>Bound</th>
          </tr>
        </thead>
        <tbody>
          ${rows.map(
            (row) => html`<tr key=${row.name} class=${row.chosen ? "selected" : ""}>
              <td class="sign">${row.chosen ? html`<span role="img" aria-label="chosen">▸</span>` : ""}</td>
              <td><button class="link mono" onClick=${() => explainProduction(source, row.name)}>${row.name}</button></td>
              <td class="number">${fixed(row.utility)}</td>
              ${names.length && !own ? html`<td class="number">${fixed(row.base)}</td>` : null}
              ${names.map((name) => html`<td key=${name} class="number">${row.parts[name] === undefined ? "" : fixed(row.parts[name])}</td>`)}
              <td class="mono">${bound(row.name)}</td>
            </tr>`,
          )}
        </tbody>
      </table>
    </div>
    ${conflict.threshold === undefined ? null : html`<p class="quiet">Production threshold ${fixed(conflict.threshold)}</p>`}
  </section>`;
}

export function ConflictSets() {
  const filtered = useEventFilter(isChoice, "choices");
  const agents = agentsOf(state.value?.parts);
  const cycles = lastCycles(filtered, at.value === null ? eventCount.value : Infinity, at.value === null ? null : at.value * 1e6);
  if (cycles.length === 0) return isGone.value ? null : html`<p class="empty">${nothingYet("No production has matched in this run.")}</p>`;
  return html`${cycles.map((cycle) => html`<${Cycle} key=${cycle.source} cycle=${cycle} agents=${agents} />`)}`;
}
