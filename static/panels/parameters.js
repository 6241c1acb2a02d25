// The model's parameters, as its class declares them: live ones take effect at once, the others with the next run.

import { html, signal, useLayoutEffect } from "../vendor/preact.js";
import { change } from "../bar/branch.js";
import { seedProblem } from "../bar/seed.js";
import { commandsOf } from "../commands.js";
import { hasMod, keyText, noteKey } from "../keys.js";
import { openTab } from "../open_tab.js";
import { match } from "../palette/fuzzy.js";
import { rangeOf, read, valuesText, written } from "../parameters/values.js";
import { Button } from "../parts/button.js";
import { valueText } from "../parts/chunk.js";
import { Inline } from "../parts/prose.js";
import { call, isLeft, sendCommand } from "../server.js";
import { isOver, runStatus } from "../run_status.js";
import { notify, session, state } from "../store.js";

/** The declarations in the text that the form is for: that of a recording, or else that of the model's file. */
const listing = signal(null);
/** The declarations in the model's file, by name: the next run begins with these. */
const present = signal(new Map());
const drafts = signal({}); // entered values that are not yet in effect, by name
const seed = signal("");
let of = {};

/** Reads the model's parameters again if the model, the run or the text has changed. Entered values stay, except those
 * that are now in effect. */
async function follow({ id, model, run, digest, gone, recorded }) {
  if (of.id === id && of.run === run && of.digest === digest && of.recorded === recorded) return;
  const other = of.id !== id;
  const asked = { id, run, digest, recorded };
  of = asked;
  if (other) {
    listing.value = null;
    drafts.value = {};
    seed.value = "";
  } else {
    drafts.value = Object.fromEntries(Object.entries(drafts.value).filter(([name, text]) => text !== written(session.value.parameters?.[name])));
  }
  if (gone) return;
  try {
    const file = call("GET", `/api/model?path=${encodeURIComponent(model)}`).then(({ listing }) => listing);
    const [now, shown] = await Promise.all([file, recorded === null ? file : call("GET", `/api/sessions/${id}/about`)]);
    if (of !== asked) return;
    present.value = new Map(now.parameters.map((parameter) => [parameter.name, parameter]));
    listing.value = shown;
  } catch (error) {
    if (of !== asked) return;
    listing.value ??= { parameters: [] };
    notify(error.message);
  }
}

/** Returns the value of a parameter in the run; for the width of a single doorway the world's value, which the slider changes too. */
function inForce({ name, live, default: otherwise }) {
  const begun = session.value?.parameters?.[name];
  const widths = Object.values(state.value?.apertures ?? {});
  if (begun !== undefined && live?.word === "aperture" && widths.length === 1) return Number(widths[0].toFixed(4));
  const changed = state.value?.parameters ?? {};
  const value = name in changed ? changed[name] : begun; // a value may be changed to none (null)
  return value === undefined ? otherwise : value;
}

/** Whether a new value of a parameter takes effect in the run at once; otherwise it is for the next run. */
function actsNow({ live }) {
  return Boolean(live && session.value?.alive) && !isOver.value;
}

function known() {
  return (listing.value?.parameters ?? []).filter((parameter) => parameter.known);
}

/** Whether the model has another text than the run by now. */
function isStale() {
  return Boolean(session.value?.stale) && !session.value.gone;
}

/** The initial values of the run's parameters that no longer exist in the text. */
function forgotten() {
  const names = new Set([...known().map(({ name }) => name), ...Object.keys(session.value?.settings ?? {})]);
  return [...names].filter((name) => !present.value.get(name)?.known);
}

/** Returns what was entered for a parameter, {value} or {problem}; null for nothing. */
function entered(parameter) {
  const text = drafts.value[parameter.name];
  return text === undefined ? null : read(parameter, text);
}

const hasProblem = () => known().some((parameter) => entered(parameter)?.problem);

/** Whether a valid value was entered that is not in effect yet. */
function waits(parameter) {
  const draft = entered(parameter);
  return draft !== null && !draft.problem && draft.value !== inForce(parameter);
}

const waiting = () => known().filter(waits);

/** Stores an entered value; that of a live parameter takes effect at once, unless the run is over. */
async function write(parameter, text, whole) {
  const { name } = parameter;
  const { value, problem } = read(parameter, text);
  const holds = !problem && value === inForce(parameter);
  // During typing, «1.» on the way to «1.5» stays unchanged, although it equals 1.
  if (holds && whole) drop(name);
  else drafts.value = { ...drafts.value, [name]: text };
  if (!actsNow(parameter) || problem || !whole || holds) return;
  const run = of;
  try {
    await change({ type: "set", name, value });
    if (run === of && drafts.value[name] === text) drop(name); // otherwise more was typed meanwhile
  } catch (error) {
    if (!isLeft(error)) notify(error.message);
  }
}

/** Discards the entered value of a field. */
function drop(name) {
  const { [name]: gone, ...others } = drafts.value;
  drafts.value = others;
}

/** Starts a new run with the values of the form; it goes on at once if the button that sends the form has the value "run". */
function restart(event) {
  event.preventDefault();
  if (hasProblem()) return;
  const settings = {};
  for (const parameter of known()) {
    const { name } = parameter;
    const draft = entered(parameter);
    const value = draft ? draft.value : inForce(parameter);
    if (present.value.get(name)?.known && value !== present.value.get(name).default) settings[name] = value;
  }
  const wanted = seed.value.trim();
  sendCommand({ type: "restart", settings, run: event.submitter?.value === "run", ...(wanted ? { seed: wanted } : {}) });
}

/** Presses «Run with these» for Mod+Enter. */
function press(event) {
  if (event.key !== "Enter" || !hasMod(event)) return;
  event.preventDefault();
  event.currentTarget.querySelector("[value=run]").click();
}

noteKey("Mod+Enter", "Run with the values of the form, in the tab Parameters", "Panels", "models folder");

function reset() {
  drafts.value = Object.fromEntries(known().map((parameter) => [parameter.name, written(parameter.default)]));
}

function Control({ parameter, id, text, problem }) {
  const { takes, choices, optional } = parameter;
  const shared = { id, "aria-describedby": `${id}-help`, "aria-invalid": Boolean(problem) };
  const change = (event) => write(parameter, event.currentTarget.value, true);
  if (takes === "switch") return html`<input ...${shared} type="checkbox" checked=${text === "true"} onChange=${(event) => write(parameter, String(event.currentTarget.checked), true)} />`;
  if (takes === "choice") {
    return html`<select ...${shared} value=${text} onChange=${change}>
      ${optional ? html`<option value="">none</option>` : null}
      ${choices.map((choice) => html`<option key=${choice} value=${String(choice)}>${String(choice)}</option>`)}
    </select>`;
  }
  // Enter sends the form, which restarts the run; the value of a live parameter takes effect without that.
  const enter = (event) => actsNow(parameter) && event.key === "Enter" && !event.defaultPrevented && (event.preventDefault(), change(event));
  return html`<input ...${shared} onKeyDown=${enter} value=${text} placeholder=${optional ? "as the model says" : ""} inputmode=${takes === "text" ? "text" : "decimal"} spellcheck=${false} autocomplete="off" onInput=${(event) => write(parameter, event.currentTarget.value, false)} onChange=${change} />`;
}

/** A slider beside the field of a number that has both bounds. */
function Slider({ parameter, text }) {
  const range = rangeOf(parameter);
  if (range === null || !Number.isFinite(Number(text)) || text === "") return null;
  const take = (whole) => (event) => write(parameter, event.currentTarget.value, whole);
  return html`<input type="range" ...${range} value=${text} aria-label="slider of ${parameter.name}" onInput=${take(false)} onChange=${take(true)} />`;
}

function Field({ parameter }) {
  const { name, unit, help } = parameter;
  const id = `parameter-${name}`;
  const text = drafts.value[name] ?? written(inForce(parameter));
  const problem = entered(parameter)?.problem;
  const changed = waits(parameter);
  return html`<div class="parameter ${changed ? "waits" : ""}">
    <label for=${id}>${name}</label>
    <span class="control"><${Control} parameter=${parameter} id=${id} text=${text} problem=${problem} /><${Slider} parameter=${parameter} text=${text} />${unit ? html`<span class="quiet">${unit}</span>` : null}</span>
    <span class="mark">${actsNow(parameter) ? html`<span class="badge" title="Acts on the run that goes on, and is recorded">live</span>` : changed ? html`<span class="badge" title="Used from the next run on">next run</span>` : null}</span>
    <p id="${id}-help" class="help">
      ${problem ? html`<span class="bad" role="alert">${problem} </span>` : null}<${Inline} text=${help} /> <span class="bounds">${valuesText(parameter)}</span>
    </p>
  </div>`;
}

const GONE = "The model's file is gone from the folder: this run cannot be restarted with other values.";

/** The values of the run alone, if there is no text that declares its parameters. */
function OfRun({ values }) {
  return html`<div class="parameters">
    <p class="note">${GONE}</p>
    ${Object.keys(values).length === 0 ? html`<p class="empty">This run has no parameters.</p>` : null}
    <table aria-label="Parameters"><tbody>
      ${Object.entries(values).map(([name, value]) => html`<tr key=${name}><th scope="row">${name}</th><td class="mono">${valueText(value)}</td></tr>`)}
    </tbody></table>
  </div>`;
}

function Parameters() {
  const shown = session.value;
  useLayoutEffect(() => void (shown && follow(shown))); // before anything can be typed into a field of the previous model
  if (!shown) return html`<p class="empty">${runStatus.value.text}</p>`;
  if (listing.value === null) return shown.gone ? html`<${OfRun} values=${shown.parameters ?? {}} />` : html`<p class="empty">Reading the model …</p>`;
  const fields = known();
  const changed = waiting().length;
  const former = forgotten();
  const stale = isStale();
  const problem = seed.value.trim() === "" ? null : seedProblem(seed.value);
  const refused = shown.gone || hasProblem() || Boolean(problem) || (shown.loading && state.value === null);
  return html`<form class="parameters" onSubmit=${restart} onKeyDownCapture=${press}>
    ${shown.gone ? html`<p class="note">${GONE}</p>` : null}
    ${stale ? html`<p class="note">The model's text has changed since this run began; the next run has the new one.</p>` : null}
    ${stale && former.length
      ? html`<p class="note">The text has no parameter <b class="mono">${former.join(", ")}</b> any more, with which this run began: «Restart with these» leaves it out.</p>`
      : null}
    ${changed ? html`<p class="note">${changed === 1 ? "One value is" : `${changed} values are`} not in effect yet: «Restart with these» below uses ${changed === 1 ? "it" : "them"}.</p>` : null}
    ${fields.length === 0 ? html`<p class="empty">This model declares no parameters. A frozen dataclass that <code>build</code> takes, or numbers and texts that are set at the top of the file, before any import, become controls here.</p>` : null}
    ${fields.map((parameter) => html`<${Field} key=${parameter.name} parameter=${parameter} />`)}
    <div class="parameter">
      <label for="parameter-seed-of-run">seed</label>
      <span class="control"><input id="parameter-seed-of-run" aria-invalid=${Boolean(problem)} inputmode="numeric" placeholder=${String(shown.seed ?? "")} value=${seed.value} onInput=${(event) => (seed.value = event.currentTarget.value)} /></span>
      <span class="mark"></span>
      <p class="help">${problem ? html`<span class="bad" role="alert">${problem} </span>` : null}The seed of all random choices; empty: that of the present run.</p>
    </div>
    <footer>
      <${Button} class="primary" disabled=${refused}>Restart with these<//>
      <${Button} value="run" title="Restart with these, and go on at once (${keyText("Mod+Enter")})" disabled=${refused}>Run with these<//>
      <${Button} type="button" onClick=${reset} disabled=${fields.length === 0}>Defaults<//>
      <${Button} type="button" onClick=${() => ((drafts.value = {}), (seed.value = ""))} disabled=${Object.keys(drafts.value).length === 0 && !seed.value}>Undo<//>
    </footer>
  </form>`;
}

// -- the parameters as commands: «Set NAME» shows its field, «Set NAME to VALUE» enters the value there

/** Shows the field of a parameter, and enters a value if one is given. */
function show(parameter, text = null) {
  openTab.value = "parameters";
  if (text !== null) write(parameter, text, true);
  requestAnimationFrame(() => {
    const field = document.getElementById(`parameter-${parameter.name}`); // once it is visible
    field?.focus();
    field?.select?.();
  });
}

/** Returns whether a text is a value of a parameter. */
function fits(parameter, text) {
  const { takes, choices } = parameter;
  if (takes === "switch") return ["true", "false"].includes(text);
  if (takes === "choice") return choices.some((choice) => String(choice) === text);
  return !read(parameter, text).problem;
}

commandsOf(
  (search) => {
    if (session.value?.gone) return [];
    const [, name = "", text = ""] = /^(?:set\s+)?(.*\S)\s+(\S+)$/i.exec(search) ?? [];
    const words = name.replace(/\s+to$/i, "");
    return known().flatMap((parameter) => {
      const about = () => [valueText(inForce(parameter)), parameter.unit].filter(Boolean).join(" ");
      const given = words && match(words, parameter.name) && fits(parameter, text);
      const setting = { text: `Set ${parameter.name} to ${text}`, about: () => (actsNow(parameter) ? "" : "from the next run on"), group: "Parameters", work: () => show(parameter, text) };
      return [{ text: `Set ${parameter.name}`, about, group: "Parameters", work: () => show(parameter) }, ...(given ? [setting] : [])];
    });
  },
  { read: () => session.peek() && follow(session.peek()), needs: "models folder" }, // if they are not known
);

export const panel = {
  id: "parameters",
  title: "Parameters",
  order: 6,
  View: Parameters,
  needs: "models folder",
  badge: () => (isStale() || waiting().length ? { text: "", title: "not in effect yet" } : null),
};
