// The form of a new experiment: a design, its levels and numbers, and how long it would take.

import { html, signal, useEffect, useLayoutEffect, useRef, useSignal } from "../vendor/preact.js";
import { remembered } from "../local_storage.js";
import { Button } from "../parts/button.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { plain, Prose } from "../parts/prose.js";
import { AGAIN, call } from "../server.js";
import { notify, session } from "../store.js";
import { shown, startExperiment } from "./list.js";
import { durationText, levelsText, readLevels } from "./wording.js";

const TYPING_PAUSE = 700; // how long the user has not typed before the design is checked [ms]
const DESIGN = remembered("design", "");
const UNKNOWN = { facts: null, seconds: null, error: null };
const EMPTY_DRAFT = { values: {}, participants: "", trials: "", workers: "" };

/** The designs, and the number of processors: {designs: [{id, name, file, model, description}], processors, most: {participants, trials, workers, levels, characters}}; null before they are known. */
const known = signal(null);
/** What was entered, by design: {values: {name: text}, participants, trials, workers}. */
const drafts = remembered("drafts of experiments", {});

const draftOf = (design) => drafts.value[design] ?? EMPTY_DRAFT;

function change(design, changes) {
  drafts.value = { ...drafts.newest(), [design]: { ...draftOf(design), ...changes } };
}

/** Returns the number of `name`, a whole number from 1 to what the server takes; null for an empty text, NaN for any other. */
function readCount(name, text) {
  return text.trim() === "" ? null : /^[1-9]\d*$/.test(text.trim()) && Number(text) <= known.value.most[name] ? Number(text) : NaN;
}

/** Returns the levels that a text lists, as far as the server takes them. */
const readTaken = (text) => readLevels(text, known.value.most);

/** Returns what the server is asked for, and the number of trials; `problem` says what is wrong. */
function requestOf(design, facts) {
  const { values, ...counts } = draftOf(design);
  const request = { design, texts: {} };
  let problem = null;
  for (const [name, text] of Object.entries(values)) {
    const { levels, texts, problem: why } = readTaken(text);
    const isFactor = Boolean(facts?.factors[name]);
    if (levels === null || (!isFactor && levels.length !== 1)) problem ??= `${name}: ${isFactor ? "levels, each once, separated by commas" : "one value"}; ${why ?? `there are ${levels.length} (got '${text}')`}`;
    else if (!isFactor || levelsText(levels) !== levelsText(facts.factors[name])) request.texts[name] = texts;
  }
  for (const [name, text] of Object.entries(counts)) {
    const count = readCount(name, text);
    if (Number.isNaN(count)) problem ??= `${name === "workers" ? "processes" : name}: must be a whole number from 1 to ${known.value.most[name].toLocaleString("en")} (got '${text}')`;
    else if (count !== null) request[name] = count;
  }
  if (!facts || problem) return { request, problem, trials: null };
  const cells = Object.entries(facts.factors).map(([name, levels]) => (request.texts[name] ?? levels).length);
  const people = Object.values(facts.groups).reduce((sum, number) => sum + (request.participants ?? number), 0);
  const trials = cells.reduce((product, number) => product * number, people * (request.trials ?? facts.trials_a_cell));
  return { request, problem, trials };
}

/** Returns how long a trial takes [s], and why it fails, as the server measured it: {seconds, error}. */
const measured = ({ seconds_a_trial: seconds, error }) => ({ seconds, error: error ? `A trial fails: ${error.trim().split("\n").at(-1)}` : null });

/** Reads the facts of a design, and then how long a trial takes [s]: the server measures it once for each version of the design's files. Returns
 * {facts, seconds, error}. */
function useDesignFacts(design) {
  const found = useSignal({ of: "", ...UNKNOWN });
  const current = () => (found.value.of === design ? found.value : UNKNOWN);
  useEffect(() => {
    if (!design) return undefined;
    const leave = new AbortController();
    const ask = (trial) => call("POST", "/api/designs/check", { design, trial }, leave.signal);
    async function read() {
      const facts = await ask(false);
      found.value = { ...UNKNOWN, of: design, facts };
      found.value = { of: design, facts, ...measured(await ask(true)) };
    }
    read().catch((error) => !leave.signal.aborted && (found.value = { ...current(), of: design, error: error.message }));
    return () => leave.abort();
  }, [design]);
  return current();
}

/** Asks the server about a design when the user pauses, if that `isWanted`; returns {answer, error} of this question, null before it is answered. */
function useChecked(question, isWanted) {
  const found = useSignal({ of: "", result: null });
  const key = JSON.stringify(question);
  useEffect(() => {
    if (!isWanted) return undefined;
    const leave = new AbortController();
    const timer = setTimeout(() => {
      call("POST", "/api/designs/check", question, leave.signal)
        .then((answer) => (found.value = { of: key, result: { answer, error: null } }))
        .catch((error) => !leave.signal.aborted && (found.value = { of: key, result: { answer: null, error: error.message } }));
    }, TYPING_PAUSE);
    return () => (clearTimeout(timer), leave.abort());
  }, [key, isWanted]);
  return found.value.of === key ? found.value.result : null;
}

/** Checks what was changed; returns {error, waiting}: what is wrong, or null. */
function useCheck(request, problem) {
  const isChanged = Object.keys(request.texts).length > 0 || request.participants !== undefined || request.trials !== undefined;
  const isWanted = isChanged && !problem;
  const checked = useChecked({ ...request, workers: undefined }, isWanted);
  return { error: checked?.error ?? null, waiting: isWanted && checked === null };
}

/** Measures how long a trial takes with the values that were changed; returns {seconds, error}. Without any, it is `usual`, that of the design. */
function useDuration({ design, texts }, problem, usual) {
  const isChanged = usual.facts !== null && Object.keys(texts).length > 0;
  const checked = useChecked({ design, texts, trial: true }, isChanged && !problem);
  if (!isChanged) return usual;
  return checked?.answer ? measured(checked.answer) : { seconds: null, error: checked?.error ?? null };
}

function DesignChoice({ design, choose }) {
  const { designs } = known.value;
  const files = [...new Set(designs.map(({ file }) => file))];
  const option = ({ id, name }) => html`<option key=${id} value=${id}>${name}</option>`;
  return html`<select aria-label="Design" value=${design} onChange=${(event) => choose(event.currentTarget.value)}>
    ${files.map((file) => html`<optgroup key=${file} label=${file ?? "The library's designs"}>${designs.filter((one) => one.file === file).map(option)}</optgroup>`)}
  </select>`;
}

/** @param isNew Whether the user has just asked for the field, and goes on in it. */
function Field({ label, value, otherwise, onInput, invalid, wide = false, isNew = false }) {
  const input = useRef(null);
  useLayoutEffect(() => void (isNew && input.current.select()), []);
  return html`<input ref=${input} class=${wide ? "" : "count"} size=${wide ? Math.max(24, value.length + 2) : null} aria-label=${label} value=${value} placeholder=${otherwise} inputmode=${wide ? "text" : "numeric"} spellcheck=${false} autocomplete="off" aria-invalid=${invalid} onInput=${(event) => onInput(event.currentTarget.value)} />`;
}

/** Returns the participants of each group of a design, if all have the same number, or else those of each. */
function numberText(groups) {
  const numbers = [...new Set(Object.values(groups))];
  return numbers.length === 1 ? String(numbers[0]) : Object.values(groups).join(", ");
}

/** @param wrong The name of the value that the server has refused; null for none. */
function Form({ design, facts, wrong }) {
  const draft = draftOf(design);
  const set = (name, text) => change(design, { values: { ...draft.values, [name]: text } });
  const unset = (name) => change(design, { values: Object.fromEntries(Object.entries(draft.values).filter(([other]) => other !== name)) });
  const added = useRef(null);
  function add({ currentTarget }) {
    added.current = currentTarget.value;
    set(added.current, defaultText(facts, added.current));
    currentTarget.value = "";
  }
  const more = Object.keys(draft.values).filter((name) => !facts.factors[name]);
  const grouped = new Set(Object.values(facts.group_parameters).flatMap(Object.keys));
  const others = ["seed", ...facts.parameters.map(({ name }) => name)].filter((name) => !facts.factors[name] && !more.includes(name));
  const settings = Object.entries(facts.settings).filter(([name]) => !more.includes(name));
  const count = (name, label, otherwise) => html`<tr>
    <th scope="row">${label}</th>
    <td><${Field} label=${label} value=${draft[name]} otherwise=${otherwise} invalid=${Number.isNaN(readCount(name, draft[name]))} onInput=${(text) => change(design, { [name]: text })} /></td>
    <td></td>
  </tr>`;
  return html`<table class="design-form">
    <tbody>
      ${Object.entries(facts.factors).map(([name, levels]) => {
        const text = draft.values[name] ?? levelsText(levels);
        const read = readTaken(text).levels;
        return html`<tr key=${name}>
          <th scope="row" title="A factor: each participant does all combinations">${name}</th>
          <td><${Field} wide label="Levels of ${name}" value=${text} invalid=${read === null || name === wrong} onInput=${(entered) => set(name, entered)} /></td>
          <td class="quiet number">${read === null ? "" : counted(read.length, "level")}
            ${draft.values[name] === undefined ? null : html`<button class="bare" title="The levels of the design" aria-label="Reset ${name}" onClick=${() => unset(name)}><${Icon} name="restart" /></button>`}</td>
        </tr>`;
      })}
      ${more.map((name) => html`<tr key=${name}>
        <th scope="row" title=${plain(facts.parameters.find((one) => one.name === name)?.help ?? "")}>${name}</th>
        <td><${Field} wide isNew=${added.current === name} label="Value of ${name}" value=${draft.values[name]} invalid=${readTaken(draft.values[name]).levels?.length !== 1 || name === wrong} onInput=${(entered) => set(name, entered)} /></td>
        <td class="quiet"><button class="bare" aria-label="Remove ${name}" title="Remove" onClick=${() => unset(name)}><${Icon} name="close" /></button></td>
      </tr>`)}
      ${others.length > 0
        ? html`<tr>
            <th scope="row"></th>
            <td colspan="2"><select class="quiet" aria-label="Set another parameter" value="" onChange=${add}>
              <option value="">Set another parameter …</option>
              ${others.map((name) => html`<option key=${name} value=${name}>${name}${grouped.has(name) ? " (of all groups)" : ""}</option>`)}
            </select></td>
          </tr>`
        : null}
      ${count("participants", Object.keys(facts.groups).length > 1 ? "participants a group" : "participants", numberText(facts.groups))}
      ${count("trials", "trials a combination", String(facts.trials_a_cell))}
      ${count("workers", "processes", String(known.value.processors))}
      ${Object.entries(facts.groups).length > 1 || grouped.size > 0
        ? html`<tr><th scope="row">groups</th><td colspan="2">${Object.keys(facts.groups).map((name) => html`<div key=${name}><b>${name}</b> <span class="quiet mono">${settingsText(facts.group_parameters[name])}</span></div>`)}</td></tr>`
        : null}
      ${settings.length > 0 ? html`<tr><th scope="row">settings</th><td colspan="2" class="quiet mono">${settingsText(Object.fromEntries(settings))}</td></tr>` : null}
      <tr><th scope="row">model</th><td colspan="2">${facts.model}</td></tr>
    </tbody>
  </table>`;
}

function defaultText(facts, name) {
  if (name === "seed") return String(facts.seed);
  const value = facts.settings[name] ?? facts.parameters.find((one) => one.name === name)?.default;
  return value === undefined || value === null || typeof value === "object" ? "" : levelsText([value]);
}

function settingsText(values) {
  return Object.entries(values ?? {}).map(([name, value]) => `${name}: ${value}`).join(", ");
}

function estimate(each, trials, workers) {
  if (each === null) return "measuring the duration of a trial …";
  const processes = Math.max(1, Math.min(workers ?? Infinity, known.value.processors));
  const all = (each * trials) / processes;
  return `${all < 1 ? "" : "about "}${durationText(all)} (${each < 0.1 ? each.toFixed(3) : each.toFixed(2)} s a trial)`;
}

/** The form of a design, and below it what an experiment of it would be. */
function Entry({ design, description, usual }) {
  const foot = useRef(null);
  const starting = useSignal(false);
  const refused = useSignal({ of: "", error: null });
  const { request, problem, trials } = requestOf(design, usual.facts);
  const check = useCheck(request, problem);
  const duration = useDuration(request, problem, usual);
  const key = JSON.stringify(request);
  const error = (refused.value.of === key ? refused.value.error : null) ?? check.error ?? duration.error;

  const { factors = {} } = usual.facts ?? {};
  const name = error?.split(": ", 1)[0];
  const wrong = name in factors || name in draftOf(design).values ? name : null;

  async function start() {
    starting.value = true;
    try {
      await startExperiment(request);
    } catch (reason) {
      if (foot.current) refused.value = { of: key, error: reason.message };
      else notify(`The experiment ${request.design.split(":").at(-1)} was not started: ${reason.message}`); // the user has left the form
    }
    starting.value = false;
  }

  return html`
    <div class="new">
      <div class="description"><${Prose} text=${description} /></div>
      ${usual.facts ? html`<${Form} design=${design} facts=${usual.facts} wrong=${wrong} />` : null}
    </div>
    ${error ? html`<pre class="trouble" role="alert">${error}</pre>` : null}
    <div class="foot" ref=${foot}>
      <span role="status">${problem ? html`<span class="bad">${problem}</span>` : trials === null ? html`<span class="quiet">${duration.error ? "" : html`<progress aria-label="Reading the design"></progress> reading the design …`}</span>` : html`<b class="number">${counted(trials, "trial")}</b> <span class="quiet">${error && duration.seconds === null ? "" : estimate(duration.seconds, trials, request.workers)}${check.waiting ? " · checking …" : ""}</span>`}</span>
      <span class="stretch"></span>
      <${Button} class="primary" disabled=${starting.value || problem !== null || wrong !== null || trials === null} title="Run all trials in the background" onClick=${start}>${starting.value ? "Starting …" : html`<${Icon} name="run" />Run`}<//>
    </div>
  `;
}

export function NewExperiment() {
  const problem = useSignal(null);
  useLayoutEffect(() => {
    let timer = 0;
    const leave = new AbortController();
    async function read() {
      try {
        known.value = await call("GET", "/api/designs", undefined, leave.signal);
        problem.value = null;
      } catch (error) {
        if (leave.signal.aborted) return;
        problem.value = error.message;
        timer = setTimeout(read, AGAIN);
      }
    }
    read();
    return () => (clearTimeout(timer), leave.abort());
  }, []);
  const isPicked = useSignal(false);
  function choose(id) {
    isPicked.value = true;
    DESIGN.value = id;
  }
  const designs = known.value?.designs ?? [];
  const last = designs.find(({ id }) => id === DESIGN.value);
  // At first one of the file that is shown, or of the model that is shown.
  const model = session.value?.model ?? "";
  const own = [...designs.filter(({ file }) => file === model), ...designs.filter((one) => one.model === model)];
  const wanted = isPicked.value || own.includes(last) ? last : (own[0] ?? last);
  const chosen = wanted ?? designs.find(({ file }) => file !== null) ?? designs[0];
  const design = chosen?.id ?? "";
  const usual = useDesignFacts(design);
  return html`
    <div class="tools">
      <button class="bare" title="All experiments" onClick=${() => (shown.value = "")}><span class="back"><${Icon} name="right" /></span>Experiments</button>
      ${known.value ? html`<${DesignChoice} design=${design} choose=${choose} />` : null}
    </div>
    <${Problem} text=${problem.value && `The designs cannot be listed: ${problem.value}`} />
    ${chosen
      ? html`<${Entry} key=${design} design=${design} description=${chosen.description} usual=${usual} />`
      : html`<div class="new">${problem.value ? null : html`<p class="late" role="status">Reading the designs …</p>`}</div>`}
  `;
}
