// Changes by hand: what a user can change in the run, from the library's registry (`actr3d.change`), and the forms and menus for it.

import { change } from "../bar/branch.js";
import { commandsOf } from "../commands.js";
import { pathsOf, productionNames, systemsOf } from "../inspector/agents.js";
import { isTooLarge, literal, TOO_LARGE } from "../parameters/values.js";
import { Button } from "../parts/button.js";
import { dialog } from "../parts/dialog.js";
import { Icon } from "../parts/icon.js";
import { Menu } from "../parts/menu.js";
import { Problem } from "../parts/problem.js";
import { Inline, plain } from "../parts/prose.js";
import { isOver, runStatus } from "../run_status.js";
import { request } from "../server.js";
import { alive, session, state } from "../store.js";
import { computed, html, signal, useState } from "../vendor/preact.js";

/** All changes that this run accepts: {word, of, title, help, text, fields: [{name, takes, required, default, unit, help}]}. */
export const changes = computed(() => session.value?.changes ?? []);

/** Why the run cannot be changed now, as a sentence; an empty text if it can. */
export const noChange = computed(() => {
  if (!alive.value) return runStatus.value.text;
  return isOver.value ? "The run is over: go back to an earlier time, or restart it." : "";
});

/** Returns the changes of one kind of thing. */
export function changesOf(of) {
  return changes.value.filter((one) => one.of === of);
}

/** Makes a change; returns whether it is made: the user may decide against it. Throws an Error with the reason if it cannot be. */
function make(word, named) {
  return change({ type: "command", word, named }).catch((error) => {
    throw new Error(error.message.replace(`${word}.`, "")); // the form names the field alone
  });
}

/** Returns {problem, send}: a function that makes a change and stores the problem for showing it beside; it returns whether it is made. */
export function useChange() {
  const [problem, setProblem] = useState(null);
  const send = async (word, named) => {
    try {
      const made = await make(word, named);
      setProblem(null);
      return made;
    } catch (error) {
      setProblem(error.message);
      return false;
    }
  };
  return { problem, send, forget: () => setProblem(null) };
}

/** Returns [unit, factor]: the unit in which people give a number of a field, and by how much numbers are larger in it. */
const unitOf = ({ unit }) => (unit === "rad" ? ["°", 180 / Math.PI] : [unit, 1]);

/** Returns the value of the text of a field: {value}, null for an empty number; or {problem}. */
function read(field, text) {
  const { name, takes, required } = field;
  if (takes.includes("number")) {
    const value = text.trim() === "" ? null : Number(text) / unitOf(field)[1];
    const wrong = value === null ? required : !Number.isFinite(value);
    return wrong ? { problem: `${name}: ${isTooLarge(text) ? TOO_LARGE : "must be a number"} (got '${text}')` } : { value };
  }
  if (!takes.includes(" | ")) return { value: text };
  try {
    return { value: literal(text.trim()) };
  } catch (error) {
    return { problem: `${name}: ${error.message} (got '${text}')` };
  }
}

/** The values among which a field is chosen, by its name; a field `name` has the name of what the change is of. */
const CHOICES = {
  aperture: () => Object.keys(session.value?.world?.widths ?? {}),
  object: () => session.value?.world?.objects ?? [],
  buffer: () => pathsOf(state.value?.parts, "buffer"),
  memory: () => pathsOf(state.value?.parts, "memory"),
  system: () => systemsOf(state.value?.parts),
  production: () => productionNames(state.value?.parts),
};

const choicesOf = ({ name }, of) => CHOICES[name === "name" ? of : name]?.() ?? [];

/** Returns the text with which the form of a field begins. */
function firstOf(field, choices) {
  if (choices.length > 0) return choices.includes(field.default) ? field.default : choices[0];
  return textOf(field, field.default);
}

/** Returns the text of a value in a form, rounded for people. */
function textOf(field, value) {
  if (typeof value !== "number") return value ?? "";
  const [unit, factor] = unitOf(field);
  return String(Number((value * factor).toFixed(unit === "°" ? 1 : 3)));
}

/** Draws the fields of a form; `choose` is called when a thing is chosen. */
function drawn(fields, values, choices, choose) {
  return fields.map((field) => {
    const { name, required } = field;
    const [unit] = unitOf(field);
    const help = field.help.replace(`[${field.unit}]`, `[${unit}]`);
    const put = (event) => (values[name] = event.currentTarget.value);
    return html`<div key=${name} class="change-field"><label class="field">
      <span>${name}${unit ? html` <span class="quiet">[${unit}]</span>` : null}</span>
      ${choices[name].length
        ? html`<select aria-describedby="help-${name}" onChange=${(event) => (put(event), choose())}>${choices[name].map((one) => html`<option key=${one} value=${one} selected=${one === values[name]}>${one}</option>`)}</select>`
        : html`<input aria-describedby="help-${name}" inputmode=${field.takes.includes("number") ? "decimal" : "text"} required=${required} value=${values[name] ?? ""} onInput=${put} />`}
      </label>
      <small class="quiet" id="help-${name}"><${Inline} text=${help} /></small>
    </div>`;
  });
}

/** Asks for the fields of a change that are not given, and makes it; an error is shown in the dialog, which stays open then, or among the
 * messages if the user has closed it. */
export async function askAndMake(one, given = {}) {
  const fields = one.fields.filter(({ name }) => !(name in given));
  const choices = Object.fromEntries(fields.map((field) => [field.name, choicesOf(field, one.of)]));
  const first = Object.fromEntries(fields.map((field) => [field.name, firstOf(field, choices[field.name])]));
  const values = { ...first };
  const problem = signal(null);
  const known = signal({}); // the present values of what is chosen, by field: exact, and as they are shown
  async function choose() {
    const named = { ...given, ...Object.fromEntries(fields.flatMap(({ name }) => (choices[name].length ? [[name, values[name]]] : []))) };
    const found = await request({ type: "present", word: one.word, named }).catch(() => ({})); // the form can do without
    const before = known.value;
    known.value = Object.fromEntries(fields.flatMap((field) => (field.name in found ? [[field.name, { value: found[field.name], text: textOf(field, found[field.name]) }]] : [])));
    for (const [name, { text }] of Object.entries(known.value)) {
      if (values[name] === (before[name]?.text ?? first[name])) values[name] = text; // what the user has written stays
    }
  }
  // Reading `known` lets the fields be drawn again.
  const Body = () => known.value && html`<p class="quiet"><${Inline} text=${one.help} /></p>${drawn(fields, values, choices, choose)}<${Problem} text=${problem.value} />`;
  const check = async () => {
    const named = { ...given };
    for (const field of fields) {
      const [text, kept] = [String(values[field.name]), known.value[field.name]];
      const { value, problem: wrong = null } = text === kept?.text ? { value: field.required ? kept.value : null } : read(field, text);
      problem.value = wrong;
      if (wrong) return false;
      if (value !== null || field.required) named[field.name] = value;
    }
    return make(one.word, named);
  };
  choose();
  await dialog({ title: one.title, body: html`<${Body} />`, actions: [{ text: one.title, kind: "primary" }], check, onError: (error) => (problem.value = error.message) });
}

commandsOf(() => (alive.value ? changes.value.map((one) => ({ text: `${one.title} …`, group: `Change by hand: ${one.of}`, work: () => askAndMake(one), ready: () => !noChange.value, why: () => noChange.value })) : []));

/** Returns whether a change needs more than is given. */
const needsMore = (one, given) => one.fields.some(({ name, required }) => required && !(name in given));

/** The buttons for all changes of a thing: one that needs nothing else is made at once, others ask for the rest. */
export function ChangeButtons({ of, given }) {
  const { problem, send } = useChange();
  const list = changesOf(of);
  if (list.length === 0) return null;
  const act = (one) => (needsMore(one, given) ? askAndMake(one, given) : send(one.word, given));
  return html`<span class="change-buttons">
      ${list.map((one) => html`<${Button} key=${one.word} disabled=${Boolean(noChange.value)} title=${noChange.value || plain(one.help)} onClick=${() => act(one)}>${one.title}<//>`)}
    </span>
    <${Problem} text=${problem} />`;
}

/** A menu with the same changes, opened by a small button: for lists with little room. */
export function ChangeMenu({ of, given, label }) {
  const { problem, send, forget } = useChange();
  const list = changesOf(of);
  if (list.length === 0) return null;
  const act = async (one, toggle) => {
    const more = needsMore(one, given);
    const done = more || (await send(one.word, given));
    toggle(!done); // a dialog that has asked has closed the menu, which shows the problem
    if (more) askAndMake(one, given);
  };
  const name = `Change ${label}`;
  return html`<${Menu} class="change-menu" label=${name} title=${noChange.value || name} face=${html`<${Icon} name="more" />`} disabled=${Boolean(noChange.value)} onClick=${forget}>
    ${(toggle) => html`${list.map((one) => html`<button key=${one.word} title=${plain(one.help)} onClick=${() => act(one, toggle)}>${one.title}</button>`)}
      <${Problem} text=${problem} />`}
  <//>`;
}
