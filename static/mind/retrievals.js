// Why a retrieval went as it did: which chunks competed, what their activations were made of, and what came of it.

import { html } from "../vendor/preact.js";
import { valueText } from "../parts/chunk.js";
import { Part } from "./why.js";

const MOST = 200; // so many candidates are listed

function outcomeText({ outcome, candidates, excluded, threshold, latency }) {
  const takes = latency === null ? "" : ` in ${valueText(latency)} s`;
  if (outcome === "retrieved") return `retrieved${takes}`;
  if (outcome === "pending") return `on its way${takes ? `, which takes${takes.slice(3)}` : ""}`;
  if (candidates.length > 0) return `failed${takes}: no candidate reaches the threshold of ${valueText(threshold)}`;
  return `failed${takes}: no chunk matches${excluded.length ? " that was not retrieved lately" : ""}`;
}

function Candidates({ reason }) {
  const { candidates, threshold } = reason;
  const names = [...new Set(candidates.flatMap(({ parts }) => Object.keys(parts)))];
  const below = threshold === null ? -1 : candidates.findIndex(({ activation }) => activation < threshold);
  return html`<div class="wide">
    <table class="candidates" aria-label="Candidates of ${reason.memory}">
      <thead>
        <tr><th>Chunk</th><th class="number">Activation</th>${names.map((name) => html`<th key=${name} class="number">${name}</th>`)}<th>Outcome</th></tr>
      </thead>
      <tbody>
        ${candidates.slice(0, MOST).map(
          (one, n) => html`<tr key=${n} class="${one.verdict.startsWith("won") ? "selected" : ""} ${n === below ? "threshold" : ""}">
            <td class="mono">${one.chunk}</td>
            <td class="number">${valueText(one.activation)}</td>
            ${names.map((name) => html`<td key=${name} class="number"><${Part} value=${one.parts[name]} /></td>`)}
            <td>${one.verdict}</td>
          </tr>`,
        )}
      </tbody>
    </table>
    ${candidates.length > MOST ? html`<p class="quiet">${candidates.length - MOST} more, none of them more active</p>` : null}
  </div>`;
}

function Retrieval({ reason }) {
  const { memory, request, asked, time, threshold, require_new: fresh, finsts, excluded, candidates, outcome } = reason;
  return html`<section aria-label="Retrieval from ${memory}">
    <h3 class=${outcome === "failed" ? "no" : ""}><span class="mono">${memory}</span>: ${outcomeText(reason)}</h3>
    <dl class="facts">
      <dt>Asked for</dt><dd class="mono">${asked}${asked === request ? "" : html` <span class="quiet">(${request})</span>`}</dd>
      <dt>At</dt><dd>${time.toFixed(3)} s${fresh ? ", for one that was not retrieved lately" : ""}</dd>
      <dt>Threshold</dt><dd>${threshold === null ? "none" : valueText(threshold)}</dd>
      ${finsts.length ? html`<dt>Retrieved lately</dt><dd class="mono">${finsts.join("; ")}</dd>` : null}
      ${excluded.length ? html`<dt>Left out for that</dt><dd class="mono">${excluded.join("; ")}</dd>` : null}
    </dl>
    ${candidates.length ? html`<${Candidates} reason=${reason} />` : null}
  </section>`;
}

/** Why a search of the eyes went as it did. */
export function Search({ reason }) {
  const { module, asked, time, bottom_up: up, outcome, why, features } = reason;
  return html`<section aria-label="Search of ${module}">
    <h3 class=${outcome === "failed" ? "no" : ""}>
      <span class="mono">${module}</span>: ${up ? "noticing" : "search"} at ${time.toFixed(3)} s for <span class="mono">${asked}</span>: ${outcome}${why ? `, ${why}` : ""}
    </h3>
    ${features.length === 0
      ? html`<p class="quiet">Nothing of that kind was in view.</p>`
      : html`<div class="wide">
          <table aria-label="Features of ${module}">
            <thead>
              <tr><th>Feature</th><th class="number">Salience</th><th>Outcome</th></tr>
            </thead>
            <tbody>
              ${features.map(
                (one, n) => html`<tr key=${n} class=${one.verdict === "chosen" ? "selected" : ""}>
                  <td class="mono">${one.feature}</td><td class="number">${one.salience === null ? "" : valueText(one.salience)}</td><td>${one.verdict}</td>
                </tr>`,
              )}
            </tbody>
          </table>
        </div>`}
  </section>`;
}

/** @param explanations What the run has answered to `explain`. */
export function Retrievals({ explanations }) {
  const retrievals = explanations.flatMap((one) => one.retrievals);
  const searches = explanations.flatMap((one) => one.searches);
  if (retrievals.length + searches.length === 0) return html`<p class="empty">Nothing had been asked of a memory or of the eyes by then.</p>`;
  return html`${retrievals.map((reason) => html`<${Retrieval} key=${reason.memory} reason=${reason} />`)}
  ${searches.map((reason) => html`<${Search} key="${reason.module} ${reason.bottom_up}" reason=${reason} />`)}`;
}
