// One experiment: its state and progress, its figure, trials, facts and report.

import { html, useEffect, useRef } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { Prose } from "../parts/prose.js";
import { whenInFull, whenText } from "../runs/wording.js";
import { dark } from "../theme.js";
import { useFacts, usePolled } from "./polling.js";
import { Figure } from "./figure.js";
import { canMakeReport, canResume, canStop, deleteExperiment, experiments, isRunning, makeReport, part, pathOf, problem, resumeExperiment, shown, stopExperiment, waitOf } from "./list.js";
import { Trials } from "./trials.js";
import { changedText, doneText, durationText, failuresText, levelsText, rateText, stateText } from "./wording.js";

const PARTS = [["figure", "Figure"], ["trials", "Trials"], ["about", "Design"], ["report", "Report"]];

/** The choice of what is shown of an experiment. */
function Parts({ experiment }) {
  const all = PARTS.filter(([id]) => id !== "report" || experiment.report);
  return html`<div class="parts"><span class="choices" role="group" aria-label="What is shown">
    ${all.map(([id, text]) => html`<button key=${id} aria-pressed=${part.value === id} onClick=${() => (part.value = id)}>${text}</button>`)}
  </span></div>`;
}

function Actions({ experiment }) {
  const { id, state, work } = experiment;
  const waits = waitOf(id) !== null;
  const inWork = waits || work.length > 0; // perhaps of another page
  return html`
    ${isRunning(experiment) ? html`<${Button} disabled=${waits || !canStop(experiment)} title="Stop; finished trials are kept, and it can go on later" onClick=${() => stopExperiment(experiment)}><${Icon} name="stop" />Stop<//>` : null}
    ${canResume(experiment) ? html`<${Button} class="primary" disabled=${waits} title=${`Run the trials that are left, ${processesText(experiment)}, with model and design as they were at its beginning`} onClick=${() => resumeExperiment(experiment)}><${Icon} name="run" />Resume<//>` : null}
    ${canMakeReport(experiment) ? html`<${Button} disabled=${inWork} title="Make the report: figures, tables, statistics" onClick=${() => makeReport(experiment)}>Make report<//>` : null}
    ${isRunning(experiment) || state === "elsewhere" ? null : html`<${Button} class="danger bare" aria-label="Delete" title="Delete" disabled=${inWork} onClick=${() => deleteExperiment(experiment)}><${Icon} name="trash" /><//>`}
  `;
}

const processesText = ({ processes }) => (processes ? `in ${counted(processes, "process", "processes")}` : "on all processors");

function Progress({ experiment }) {
  const { id, done, total, failures, rate, remaining, state, workers, work } = experiment;
  const wait = waitOf(id);
  const going = state === "running" || state === "stopping";
  const facts = [
    going && done === 0 ? (workers > 0 ? "the first trials are running …" : "starting …") : null,
    rate && state === "running" ? rateText(rate) : null,
    remaining !== null && state === "running" ? `${durationText(remaining)} left` : null,
    going && workers > 0 && done > 0 ? counted(workers, "process", "processes") : null,
  ].filter(Boolean);
  return html`<div class="progress" role="status">
    <progress aria-label="Finished trials" value=${done} max=${total ?? Math.max(1, done)}></progress>
    <span class="number">${doneText(experiment)}</span>
    ${facts.map((text) => html`<span key=${text.replace(/[\d.,]+/g, "")} class="number quiet">${text}</span>`)}
    ${failures > 0 ? html`<span class="bad number">${failuresText(failures)}</span>` : null}
    ${wait ? html`<span class="stretch"></span><span class="doing"><progress aria-label=${wait.text}></progress> ${wait.text} ${wait.cancel ? html`<button class="bare" onClick=${() => wait.cancel.abort()}>Cancel</button>` : null}</span>` : work.map((text) => html`<span key=${text} class="quiet">${text} …</span>`)}
  </div>`;
}

function About({ experiment, facts }) {
  const rows = [
    ["began", whenInFull(experiment.made)],
    ["folder", html`<span class="mono">.workbench/experiments/${experiment.id}</span>`],
    ["changed", changedText(experiment.changed) || "nothing"],
    ["model", facts.model && `${facts.model}, as it was at the beginning`],
    ...Object.entries(facts.factors ?? {}).map(([name, levels]) => [name, levelsText(levels)]),
    ...Object.entries(facts.groups ?? {}).map(([name, number]) => [
      `group ${name}`,
      `${counted(number, "participant")}; ${Object.entries(facts.group_parameters?.[name] ?? {}).map(([key, value]) => `${key} ${valueText(value)}`).join(", ") || "no parameters"}`,
    ]),
    ...Object.entries(facts.settings ?? {}).map(([name, value]) => [name, valueText(value)]),
    ["trials a combination", facts.trials_a_cell],
    ["seed", facts.seed],
  ];
  return html`<div class="part about-design">
    <div class="description"><${Prose} text=${facts.description ?? ""} /></div>
    <table><tbody>${rows.filter(([, value]) => value !== undefined && value !== "").map(([name, value]) => html`<tr key=${name}><th scope="row">${name}</th><td>${value}</td></tr>`)}</tbody></table>
  </div>`;
}

/** The report, in the theme of the page: it has no script that could follow it. */
function Report({ address }) {
  const frame = useRef(null);
  const paint = () => frame.current.contentDocument?.documentElement?.style.setProperty("color-scheme", dark.value ? "dark" : "light");
  useEffect(paint, [dark.value]);
  return html`<iframe ref=${frame} class="part report" title="Report" sandbox="allow-downloads allow-same-origin" src=${address} onLoad=${paint}></iframe>`;
}

function Contents({ experiment, facts, error }) {
  const path = pathOf(experiment.id);
  const columns = usePolled(`${path}/rows?most=1`, experiment.done > 0 ? experiment.state : "").answer?.columns ?? [];
  if (facts === null && error !== null) return html`<p class="part problem bad" role="alert">The experiment cannot be read: ${error}</p>`;
  if (facts === null) return html`<p class="part empty" role="status"><progress aria-label="Reading"></progress> Reading the experiment …</p>`;
  if (part.value === "about") return html`<${About} experiment=${experiment} facts=${facts} />`;
  if (part.value === "trials") return html`<${Trials} experiment=${experiment} facts=${facts} />`;
  if (part.value === "report" && experiment.report) {
    const report = `${path}/report/index.html?${experiment.report}`;
    return html`
      <div class="menus"><a href=${report} target="_blank" rel="noopener">in a tab of its own</a></div>
      <${Report} address=${report} />
    `;
  }
  if (columns.length > 2) return html`<${Figure} experiment=${experiment} facts=${facts} columns=${columns} />`;
  return html`<p class="part empty" role="status">${isRunning(experiment) ? "The figure appears with the first finished trials." : experiment.done > 0 ? html`<progress aria-label="Reading"></progress> Reading the trials …` : "No trial has finished."}</p>`;
}

export function Experiment() {
  const experiment = experiments.value?.find(({ id }) => id === shown.value);
  const { facts, error } = useFacts(experiment);
  const back = () => (shown.value = "");
  return html`
    <div class="tools">
      <button class="bare" title="All experiments" onClick=${back}><span class="back"><${Icon} name="right" /></span>Experiments</button>
      <b class="name" title=${[experiment.model, experiment.id].filter(Boolean).join("\n")}>${experiment.name}</b>
      <span class="quiet when" title=${whenInFull(experiment.made)}>${whenText(experiment.made)}</span>
      <span class="state ${experiment.state}">${stateText(experiment)}</span>
      <span class="stretch"></span>
      <${Actions} experiment=${experiment} />
    </div>
    <${Progress} experiment=${experiment} />
    <${Problem} text=${problem.value && `The state of the experiment is not known: ${problem.value}`} />
    ${experiment.problem ? html`<pre class="trouble" role="alert">${experiment.problem}</pre>` : null}
    <div class="contents"><${Parts} experiment=${experiment} /><${Contents} key="${experiment.id}" experiment=${experiment} facts=${facts} error=${error} /></div>
  `;
}
