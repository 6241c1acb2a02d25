// The productions: the firing trace above, and the explanations below: conditions, the conflict set, retrievals.

import { html, useLayoutEffect, useState } from "../vendor/preact.js";
import { AtStart } from "../inspector/at_start.js";
import { at, question, shownReasons } from "../inspector/explanation.js";
import { HeldNote, held } from "../inspector/breakpoints.js";
import { ConflictSets } from "../inspector/conflict.js";
import { useWrittenAgents } from "../inspector/description.js";
import { explained, ProductionList, productionsOf } from "../inspector/production_list.js";
import { Retrievals } from "../inspector/retrievals.js";
import { FiringTrace } from "../inspector/trace.js";
import { Placeholder } from "../inspector/placeholder.js";
import { Why } from "../inspector/why.js";
import { useAnswer } from "../parts/answer.js";
import { Splitter } from "../parts/splitter.js";
import { plainTime, timeOfText, timeUnit } from "../parts/units.js";
import { remembered } from "../local_storage.js";
import { running, state } from "../store.js";
import { furthest, runTimeText, travel } from "../timeline/seek.js";

const below = remembered("reasons height", Math.round(Math.min(270, 0.27 * innerHeight)));

function Moment({ result }) {
  const [text, setText] = useState("");
  useLayoutEffect(() => setText(at.value === null ? "" : plainTime(at.value, null, furthest.peek())), [at.value]);
  const wrong = text.trim() !== "" && !(timeOfText(text) >= 0);

  function take(event) {
    if (event.type === "keydown" && event.key !== "Enter") return;
    if (!wrong) at.value = text.trim() === "" ? null : timeOfText(text);
  }

  const time = result.answer?.[0]?.time;
  return html`<label class="moment" title="The moment that is explained; nothing for the present one">
      at <input aria-label="Explain the time${timeUnit(furthest.value)}" aria-invalid=${wrong} inputmode="decimal" placeholder=${plainTime(time ?? state.value?.time ?? 0, 3, furthest.value)} value=${text} onInput=${(event) => setText(event.currentTarget.value)} onKeyDown=${take} onBlur=${take} />${timeUnit(furthest.value) ? " s" : ""}
    </label>
    <button aria-pressed=${at.value === null} title="Explain the present moment" onClick=${() => (at.value = null)}>Now</button>`;
}

/** The hint if the run cannot explain the requested moment. */
function Elsewhere() {
  const known = at.value <= (state.value?.furthest ?? 0) && at.value > (state.value?.time ?? 0);
  return html`<p class="elsewhere">
    ${known ? html`<button onClick=${() => travel(at.value)}>Go to ${runTimeText(at.value, null)}</button>` : null}
    <button onClick=${() => (at.value = null)}>Explain the present moment</button>
  </p>`;
}

const VIEWS = [
  { id: "why", text: "Why" },
  { id: "conflict", text: "Conflict set" },
  { id: "retrievals", text: "Retrievals" },
];

function Reasons() {
  const result = useAnswer(question.value, { once: at.value !== null });
  const explanations = result.answer ?? [];
  const shown = VIEWS.some(({ id }) => id === shownReasons.value) ? shownReasons.value : "why";
  const written = useWrittenAgents().flatMap(({ name: system, productions }) => productions.toSorted().map((name) => ({ system, name, reason: null })));
  const there = productionsOf(
    state.value?.parts,
    explanations.flatMap((one) => one.productions),
  );
  const all = written.length > 0 ? written : there;
  const chosen = explained(all);
  const time = explanations[0]?.time;
  const old = running.value && at.value === null && time !== undefined;
  const choose = (event, id) => {
    const n = VIEWS.findIndex((view) => view.id === id) + ({ ArrowRight: 1, ArrowLeft: -1 }[event.key] ?? 0);
    shownReasons.value = VIEWS[(n + VIEWS.length) % VIEWS.length].id;
    event.currentTarget.parentElement.children[(n + VIEWS.length) % VIEWS.length].focus();
    event.preventDefault();
  };
  return html`<section class="reasons" aria-label="Explanations">
    <h2 class="unseen">Explanations</h2>
    <div class="tools">
      <div class="choices" role="tablist" aria-label="Explanations">
        ${VIEWS.map(
          ({ id, text }) => html`<button key=${id} role="tab" id="reasons-${id}" aria-controls="reasons-panel" aria-selected=${shown === id} tabindex=${shown === id ? 0 : -1} onClick=${(event) => choose(event, id)} onKeyDown=${(event) => ["ArrowLeft", "ArrowRight"].includes(event.key) && choose(event, id)}>${text}</button>`,
        )}
      </div>
      <span class="stretch"></span>
      ${old && shown !== "conflict" ? html`<span class="quiet" role="status">as it was at ${runTimeText(time, 3)}</span>` : null}
      <${Moment} result=${result} />
    </div>
    <div class="reasons-body ${shown}" role="tabpanel" id="reasons-panel" aria-labelledby="reasons-${shown}">
      ${shown === "why" ? html`<${ProductionList} all=${all} chosen=${chosen} />` : null}
      <div class="reasons-text" tabindex="0" role="region" aria-label="Explanation">
        <${AtStart} />
        <${Placeholder} answer=${result} />
        ${result.error && at.value !== null ? html`<${Elsewhere} />` : null}
        ${shown === "why" ? html`<div id="why-text">${result.error ? null : html`<${Why} item=${chosen} />`}</div>` : null}
        ${shown === "conflict" ? html`<${ConflictSets} />` : null}
        ${shown === "retrievals" && result.answer ? html`<${Retrievals} explanations=${explanations} />` : null}
      </div>
    </div>
  </section>`;
}

function Productions() {
  return html`<div class="productions">
    <${HeldNote} />
    <${FiringTrace} />
    <${Splitter} size=${below} along="rows" label="Height of the explanations" least=${120} most=${() => Math.max(160, innerHeight - 420)} />
    <div class="reasons-place" style=${{ height: `${below.value}px` }}><${Reasons} /></div>
  </div>`;
}

export const panel = {
  id: "productions",
  title: "Productions",
  order: 3,
  View: Productions,
  badge: () => (held.value === null ? null : { text: "", title: "paused at a breakpoint", level: "bad" }),
};
