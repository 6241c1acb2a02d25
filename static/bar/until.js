// «Run until»: a time, a production, a buffer that matches a pattern, a contact; and which breakpoints there are.

import { html, signal, useId } from "../vendor/preact.js";
import { dialog } from "../parts/dialog.js";
import { breakpoints, toggleBreakpoint } from "../mind/breakpoints.js";
import { complain, session, state } from "../store.js";
import { orderThere } from "../timeline/seek.js";

const KINDS = [["time", "a time"], ["production", "a production fires"], ["buffer", "a buffer matches"], ["contact", "something is touched"]];
const kind = signal("time");
const time = signal("");
const production = signal("");
const buffer = signal("");
const pattern = signal("");
const body = signal("");

function partsThat(holds) {
  return Object.entries(state.value?.parts ?? {}).filter(([, part]) => holds(part));
}

/** Returns the productions of all agents by name. */
export function productionNames() {
  return [...new Set(partsThat((part) => part.is === "system").flatMap(([, part]) => part.productions))].sort();
}

function wanted() {
  switch (kind.value) {
    case "time":
      return { type: "until", time: Number(time.value) };
    case "production":
      return { type: "until", production: production.value };
    case "buffer":
      return { type: "until", buffer: buffer.value, pattern: pattern.value };
    default:
      return { type: "until", contact: body.value };
  }
}

function bufferPaths() {
  return partsThat((part) => part.is === "buffer").map(([path]) => path);
}

function Line({ id, text, children }) {
  return html`<div class="until ${kind.value === id ? "on" : ""}">
    <label><input type="radio" name="until" checked=${kind.value === id} onChange=${() => (kind.value = id)} /> ${text}</label>
    <span onInput=${() => (kind.value = id)}>${children}</span>
  </div>`;
}

/** A name that can be written, too: of a program that has not begun none is known yet. */
function Name({ of, among, label, otherwise }) {
  const id = useId();
  return html`<input aria-label=${label} list=${id} class="mono" spellcheck="false" placeholder=${otherwise} value=${of.value} onInput=${(event) => (of.value = event.currentTarget.value)} />
    <datalist id=${id}>${among.map((name) => html`<option key=${name} value=${name} />`)}</datalist>`;
}

function Body() {
  const texts = Object.fromEntries(KINDS);
  const stops = breakpoints.value;
  const bodies = Object.keys(session.value?.world?.bodies ?? {});
  return html`
    <${Line} id="time" text=${texts.time}>
      <input aria-label="Time [s]" inputmode="decimal" size="8" value=${time.value} onInput=${(event) => (time.value = event.currentTarget.value)} /> s
    <//>
    <${Line} id="production" text=${texts.production}><${Name} of=${production} among=${productionNames()} label="Production" otherwise="its name" /><//>
    <${Line} id="buffer" text=${texts.buffer}>
      <${Name} of=${buffer} among=${bufferPaths()} label="Buffer" otherwise="its path" />
      <input aria-label="Pattern" class="mono" placeholder="slot:value slot:?x" value=${pattern.value} onInput=${(event) => (pattern.value = event.currentTarget.value)} />
    <//>
    ${bodies.length ? html`<${Line} id="contact" text=${texts.contact}><${Name} of=${body} among=${bodies} label="Body" otherwise="by any body" /><//>` : null}
    <h3>Breakpoints</h3>
    ${stops.length
      ? html`<ul class="stops">${stops.map((name) => html`<li key=${name}><span class="mono">${name}</span><button class="bare" aria-label="Remove the breakpoint on ${name}" onClick=${() => toggleBreakpoint(name)}>✕</button></li>`)}</ul>`
      : html`<p class="quiet">None. In the tab Productions one is set beside each production.</p>`}
  `;
}

/** Asks until when, and runs until then. */
export async function runUntil() {
  const actions = [{ text: "Cancel", value: false }, { text: "Run until then", value: true, kind: "primary" }];
  if (!(await dialog({ title: "Run until", body: html`<${Body} />`, actions }))) return;
  const missing = { time: !(Number(time.value) > 0) && "a number of seconds", production: !production.value && "its name", buffer: !buffer.value && "its path" }[kind.value];
  if (missing) {
    complain(`Run until ${Object.fromEntries(KINDS)[kind.value]}: ${missing} is wanted`);
    return;
  }
  orderThere(wanted());
}
