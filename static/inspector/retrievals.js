// Explains a retrieval: which chunks competed, the components of their activations, and the result.

import { html } from "../vendor/preact.js";
import { requestText, valueText } from "../parts/chunk.js";
import { runTimeText } from "../timeline/seek.js";
import { fixed, Part, partName } from "./part_names.js";

const MAX_CANDIDATES = 200; // the maximum number of candidates listed

function outcomeText({ outcome, candidates, excluded, threshold, latency }) {
  const takes = latency === null ? "" : ` in ${valueText(latency)} s`;
  if (outcome === "retrieved") return `retrieved${takes}`;
  if (outcome === "pending") return `on its way${takes ? `, which takes${takes.slice(3)}` : ""}`;
  if (candidates.length > 0) return `failed${takes}: no candidate reaches the threshold of ${valueText(threshold)}`;
  return `failed${takes}: no chunk matches${excluded.length ? ", apart from recently retrieved ones (finsts)" : ""}`;
}

function Candidates({ reason }) {
  const { candidates, threshold } = reason;
  const names = [...new Set(candidates.flatMap(({ parts }) => Object.keys(parts)))];
  const below = threshold === null ? -1 : candidates.findIndex(({ activation }) => activation < threshold);
  return html`<div class="wide">
    <table class="candidates" aria-label="Candidates of ${reason.memory}">
      <thead>
        <tr><th>Chunk</th><th>Outcome</th><th class="number">Activation</th>${names.map((name) => html`<th key=${name} class="number" title=${name}>${partName(name)}</th>`)}</tr>
      </thead>
      <tbody>
        ${candidates.slice(0, MAX_CANDIDATES).map(
          (one, n) => html`<tr key=${n} class="${one.verdict.startsWith("won") ? "selected" : ""} ${n === below ? "threshold" : ""}">
            <td class="mono long">${one.chunk}</td>
            <td class="verdict">${one.verdict}</td>
            <td class="number">${fixed(one.activation)}</td>
            ${names.map((name) => html`<td key=${name} class="number"><${Part} value=${one.parts[name]} /></td>`)}
          </tr>`,
        )}
      </tbody>
    </table>
    ${candidates.length > MAX_CANDIDATES ? html`<p class="quiet">${candidates.length - MAX_CANDIDATES} more, none of them more active</p>` : null}
  </div>`;
}

function Lately({ title, chunks, open = false }) {
  if (chunks.length === 0) return null;
  return html`<details class="lately" open=${open}>
    <summary class="quiet">${title}: ${chunks.length}</summary>
    <ul class="mono">${chunks.map((chunk, n) => html`<li key=${n}>${chunk}</li>`)}</ul>
  </details>`;
}

function Retrieval({ reason }) {
  const { memory, request, asked, time, threshold, require_new: fresh, finsts, excluded, candidates, outcome } = reason;
  return html`<section aria-label="Retrieval from ${memory}">
    <h3 class=${outcome === "failed" ? "failed" : ""}><span class="mono">${memory}</span>: ${outcomeText(reason)}</h3>
    <p>
      <span class="quiet">Asked for</span> <span class="mono">${requestText(asked)}</span>${requestText(asked) === requestText(request) ? null : html` <span class="quiet mono">(${requestText(request)})</span>`}
      <span class="quiet"> at ${runTimeText(time, 3)}, ${threshold === null ? "no threshold" : `threshold ${valueText(threshold)}`}${fresh ? ", only what was not retrieved recently" : ""}</span>
    </p>
    ${candidates.length ? html`<${Candidates} reason=${reason} />` : null}
    <${Lately} title="Matched, but left out as retrieved recently" chunks=${excluded} open=${excluded.length < 4} />
    <${Lately} title="All chunks marked as retrieved recently (finsts)" chunks=${finsts} />
  </section>`;
}

/** Explains a visual search. */
export function Search({ reason }) {
  const { module, asked, time, bottom_up: up, outcome, why, features } = reason;
  return html`<section aria-label="Search of ${module}">
    <h3 class=${outcome === "failed" ? "failed" : ""}>
      <span class="mono">${module}</span>: ${up ? "noticing" : "search"} at ${runTimeText(time, 3)} for <span class="mono">${asked}</span>: ${outcome}${why ? `, ${why}` : ""}
    </h3>
    ${features.length === 0
      ? html`<p class="quiet">Nothing of that kind was in view.</p>`
      : html`<div class="wide">
          <table aria-label="Features of ${module}">
            <thead>
              <tr><th>Outcome</th><th class="number">Salience</th><th>Feature</th></tr>
            </thead>
            <tbody>
              ${features.map(
                (one, n) => html`<tr key=${n} class=${one.verdict === "chosen" ? "selected" : ""}>
                  <td class="verdict">${one.verdict}</td><td class="number">${one.salience === null ? "" : valueText(one.salience)}</td><td class="mono long">${one.feature}</td>
                </tr>`,
              )}
            </tbody>
          </table>
        </div>`}
  </section>`;
}

/** @param explanations The run's answer to `explain`. */
export function Retrievals({ explanations }) {
  const retrievals = explanations.flatMap((one) => one.retrievals);
  const searches = explanations.flatMap((one) => one.searches);
  if (retrievals.length + searches.length === 0) return html`<p class="empty">No retrieval and no visual search had been requested by that time.</p>`;
  return html`${retrievals.map((reason) => html`<${Retrieval} key=${reason.memory} reason=${reason} />`)}
  ${searches.map((reason) => html`<${Search} key="${reason.module} ${reason.bottom_up}" reason=${reason} />`)}`;
}
