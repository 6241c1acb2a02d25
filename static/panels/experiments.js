// Experiments: a design run by many trials; their progress, figures and rows, and each trial in the 3D view.

import { html, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { agoText, whenInFull, whenText } from "../runs/wording.js";
import { experiments, followExperiments, isRunning, listExperiments, part, problem, showExperiment, shown, total } from "../experiments/list.js";
import { NewExperiment } from "../experiments/new_experiment.js";
import { Experiment } from "../experiments/experiment.js";
import { changedText, doneText, durationText, failuresText, stateText } from "../experiments/wording.js";

/** What a row says below the state: what is made of the experiment now, how long it still takes, or what failed. */
function Note({ experiment }) {
  const { failures, remaining, work } = experiment;
  if (work.length > 0) return html`<span title=${work.join("\n")}>${work.join(", ")} …</span>`;
  if (isRunning(experiment) && remaining !== null) return `${durationText(remaining)} left`;
  return failures > 0 ? html`<span class="bad">${failuresText(failures)}</span>` : null;
}

function Row({ experiment }) {
  const { id, name, model, made, state, done, total, changed } = experiment;
  const open = () => showExperiment(id);
  const how = changedText(changed) || "as designed";
  return html`<tr data-experiment=${id} onClick=${open}>
    <td class="name" title=${[model, how].filter(Boolean).join("\n")}>
      <button class="link" onClick=${(event) => (event.stopPropagation(), open())}>${name}</button>
      <small>${model ? html`<span class="path"><bdi>${model}</bdi></span>` : null}<span>${how}</span></small>
    </td>
    <td class="when" title=${whenInFull(made)}><span class="number">${whenText(made)}</span><small>${agoText(made)}</small></td>
    <td class="state ${state}"><span>${stateText(experiment)}</span><small><${Note} experiment=${experiment} /></small></td>
    <td class="done"><span class="number">${doneText(experiment)}</span><progress aria-label="Finished trials" value=${done} max=${total ?? Math.max(1, done)}></progress></td>
  </tr>`;
}

function List() {
  const all = experiments.value;
  const begin = html`<button class="primary" onClick=${() => (shown.value = "new")}>New experiment</button>`;
  return html`
    <div class="tools">
      ${begin}
      <span class="stretch"></span>
      <span class="quiet number" role="status">${all === null ? "" : total.value > all.length ? `the newest ${all.length} of ${total.value.toLocaleString("en")}` : all.length}</span>
      <button class="bare" title="Read the list again" aria-label="Read the list again" onClick=${listExperiments}><${Icon} name="restart" /></button>
    </div>
    <${Problem} text=${problem.value && `The experiments cannot be listed: ${problem.value}`} />
    ${all === null ? html`<p class="empty" role="status">${problem.value ? "" : "Reading the experiments …"}</p>` : null}
    ${all?.length === 0 ? html`<p class="empty">No experiments yet. An experiment runs a model many times: for several participants, in all combinations of conditions. Each trial can be opened in the 3D view.</p>` : null}
    ${all?.length > 0
      ? html`<div class="list"><table aria-label="Experiments">
          <thead><tr><th scope="col">Design</th><th scope="col" class="when">Began</th><th scope="col" class="state">State</th><th scope="col" class="done">Finished</th></tr></thead>
          <tbody>${all.map((experiment) => html`<${Row} key=${experiment.id} experiment=${experiment} />`)}</tbody>
        </table></div>`
      : null}
  `;
}

function Experiments() {
  useEffect(followExperiments, []);
  const isThere = experiments.value?.some(({ id }) => id === shown.value);
  const place = useRef(null);
  const last = useRef(null);
  const now = shown.value === "new" || isThere ? shown.value : "";
  // What had the focus may be gone with the view before: then it goes to the row of that view, or to the first control; if only another part
  // of an experiment is shown, to the button of that part. The former at once: a `Button` that is gone looks for another place later.
  const goOn = (...controls) => document.activeElement === document.body && controls.map((one) => place.current.querySelector(one)).find(Boolean)?.focus();
  useLayoutEffect(() => {
    if (last.current !== null) goOn(`[data-experiment="${CSS.escape(last.current)}"] button`, ".tools button");
    last.current = now;
  }, [now]);
  useEffect(() => void (now === last.current && goOn(".parts [aria-pressed=true]")), [part.value]);
  const view = shown.value === "new" ? html`<${NewExperiment} />` : isThere ? html`<${Experiment} />` : html`<${List} />`;
  return html`<div class="experiments" ref=${place}>${view}</div>`;
}

export const panel = { id: "experiments", title: "Experiments", order: 8.5, View: Experiments, needs: "models folder" };
