// «Run until»: a time, a production, a buffer that matches a pattern, a contact; and the list of breakpoints.

import { html, signal, useId } from "../vendor/preact.js";
import { commandsOf } from "../commands.js";
import { dialog } from "../parts/dialog.js";
import { TIMES, timeOfText } from "../parts/units.js";
import { agentsOf, nameIn, pathsOf, productionNames } from "../inspector/agents.js";
import { breakpoints, toggleBreakpoint } from "../inspector/breakpoints.js";
import { isLeft } from "../server.js";
import { bodies, state } from "../store.js";
import { requestThere } from "../timeline/seek.js";

const TEXTS = { time: "a time", production: "a production fires", buffer: "a buffer matches", contact: "something is touched" };
const kind = signal("time");
const time = signal("");
const production = signal("");
const buffer = signal("");
const pattern = signal("");
const body = signal("");
/** Why it cannot run until then, {field, text}: the field that is wrong, null for none; null if it can. */
const problem = signal(null);

const productions = () => productionNames(state.value?.parts).sort();

/** Returns the problem with an entry, such as an invalid time or a missing name; null if it can be sent. */
function missing() {
  const wanted = timeOfText(time.value);
  if (kind.value === "time" && !(wanted >= 0 && wanted < 1e9)) return { field: "time", text: `enter a time, such as ${TIMES}` };
  if (kind.value === "production" && !production.value) return { field: "production", text: "enter the name of a production" };
  return kind.value === "buffer" && !buffer.value ? { field: "buffer", text: "enter the name of a buffer" } : null;
}

/** Returns the problem that an error of the server states, without the name of the field, beside which it is shown. */
function problemOf({ message, field = null }) {
  return { field, text: field === null ? message : message.slice(`${field}: `.length) };
}

commandsOf(() => productions().map((name) => ({ text: `${breakpoints.value.includes(name) ? "Remove the breakpoint" : "Breakpoint"} on ${name}`, group: "Run", work: () => toggleBreakpoint(name) })));

function wanted() {
  const ends = {
    time: { time: timeOfText(time.value) },
    production: { production: production.value },
    buffer: { buffer: buffer.value, pattern: pattern.value },
    contact: { contact: body.value },
  };
  return { type: "until", ...ends[kind.value] };
}

/** Whether there is no production of this name any more, for example after an edit; unknown before a program has started. */
function isLost(name) {
  const names = productions();
  return names.length > 0 && !names.includes(name);
}

/** Returns the names of the buffers as in the panel Buffers; preceded by the agent's name if there are several agents. */
function bufferNames() {
  const { parts } = state.value ?? {};
  const agents = agentsOf(parts);
  const paths = pathsOf(parts, "buffer");
  return agents.length === 1 ? paths.map((path) => nameIn(agents[0], path)) : paths;
}

function Line({ id, children }) {
  const choose = () => {
    kind.value = id;
    problem.value = null;
  };
  return html`<div class="until ${kind.value === id ? "on" : ""}">
    <label><input type="radio" name="until" checked=${kind.value === id} onChange=${choose} /> ${TEXTS[id]}</label>
    <span onInput=${choose}>${children}</span>
    ${problem.value && kind.value === id ? html`<p class="bad" role="alert">${problem.value.text}</p>` : null}
  </div>`;
}

const isWrong = (field) => problem.value?.field === field;

/** A name that can also be typed: before a program has started, no names are known. */
function Name({ of, field, among, label, otherwise, first }) {
  const id = useId();
  return html`<input aria-label=${label} data-first=${first} list=${id} class="mono" spellcheck=${false} aria-invalid=${isWrong(field)} placeholder=${otherwise} value=${of.value} onInput=${(event) => (of.value = event.currentTarget.value)} />
    <datalist id=${id}>${among.map((name) => html`<option key=${name} value=${name} />`)}</datalist>`;
}

function Body() {
  const touching = Object.keys(bodies.value);
  const stops = breakpoints.value;
  return html`
    <${Line} id="time">
      <input aria-label="Time [s]" aria-invalid=${isWrong("time")} data-first=${kind.value === "time"} inputmode="decimal" size="8" value=${time.value} onInput=${(event) => (time.value = event.currentTarget.value)} /> s
    <//>
    <${Line} id="production"><${Name} of=${production} field="production" among=${productions()} label="Production" first=${kind.value === "production"} otherwise="its name" /><//>
    <${Line} id="buffer">
      <${Name} of=${buffer} field="buffer" among=${bufferNames()} label="Buffer" first=${kind.value === "buffer"} otherwise="its name" />
      <input aria-label="Pattern" aria-invalid=${isWrong("pattern")} class="mono" placeholder="slot:value slot:?x" value=${pattern.value} onInput=${(event) => (pattern.value = event.currentTarget.value)} />
    <//>
    ${touching.length ? html`<${Line} id="contact"><${Name} of=${body} field="contact" among=${touching} label="Body" first=${kind.value === "contact"} otherwise="by any body" /><//>` : null}
    <h3>Breakpoints</h3>
    ${stops.length
      ? html`<ul class="stops">${stops.map((name) => html`<li key=${name}><span class="mono">${name}</span>${isLost(name) ? html`<span class="quiet">not in this run</span>` : null}<button class="bare" aria-label="Remove the breakpoint on ${name}" onClick=${() => toggleBreakpoint(name)}>✕</button></li>`)}</ul>`
      : html`<p class="quiet">None. In the tab Productions one is set beside each production.</p>`}
  `;
}

/** Asks until when to run, and runs until then; stays open, with the reason, if that is not possible. */
export async function runUntil() {
  problem.value = null;
  if (kind.value === "contact" && Object.keys(bodies.value).length === 0) kind.value = "time";
  async function check() {
    problem.value = missing();
    if (problem.value) return false;
    await requestThere(wanted()).catch((error) => {
      if (!isLeft(error)) throw error;
    });
    return true;
  }
  await dialog({ title: "Run until", body: html`<${Body} />`, actions: [{ text: "Run until then", kind: "primary" }], check, onError: (error) => (problem.value = problemOf(error)) });
}
