// Users' changes as text: `aperture 50 -> 40 cm`, `speed 1.2 -> 1.5 m/s`, `set goal count 2 -> count 3`.

import { changes } from "../changes/changes.js";
import { runOf } from "../inspector/agents.js";
import { chunkText, valueText } from "../parts/chunk.js";
import { session } from "../store.js";

const before = new WeakMap(); // by event: the value that the change has replaced, as text

/** Stores the values that users' changes replace, from event to event. */
export class ReplacedValues {
  #values = new Map();
  #buffers = new Map();

  /** Stores the chunk of a buffer: [present, the one before]. */
  hold(source, chunk) {
    this.#buffers.set(source, [chunkText(chunk), this.#buffers.get(source)?.[0] ?? ""]);
  }

  /** Stores the effect of a command; called in order. */
  take(event) {
    const setting = settingOf(event[3]);
    if (setting === null || setting.of === "place") return; // a thing may have moved since it was put somewhere
    const { of, text } = setting;
    const key = keyOf(event, setting);
    const known = of === "buffer" ? this.#buffers.get(named(event[3]).buffer)?.[1] || "empty" : (this.#values.get(key) ?? startOf(setting, event));
    if (known !== undefined) before.set(event, known);
    this.#values.set(key, text);
  }
}

const cm = (width) => String(Number((100 * width).toFixed(1)));

/** Returns the width of an aperture or the value of a model's parameter at the start of its run as text; undefined for other values. */
function startOf({ of, parameter }, [, source, , command]) {
  const { initial_widths: initialWidths, parameters } = session.peek() ?? {};
  if (of === "aperture") {
    const [, widths] = initialWidths?.findLast(([first]) => first <= runOf(source)) ?? [];
    const width = widths?.[named(command).name];
    return width === undefined ? undefined : cm(width);
  }
  return parameter && parameter.name in (parameters ?? {}) ? valueText(parameters[parameter.name]) : undefined;
}

function changeOf({ command, data }) {
  return data?.body ? undefined : changes.peek().find(({ word }) => word === command);
}

/** Returns the arguments of a change by the names of its fields. */
function named({ command, data }) {
  const { fields = [] } = changeOf({ command, data }) ?? {};
  const given = Object.fromEntries((data?.values ?? []).map((value, n) => [fields[n]?.name ?? `${n + 1}`, value]));
  return { ...Object.fromEntries(fields.filter(({ default: first }) => first !== null).map(({ name, default: first }) => [name, first])), ...given, ...data?.named };
}

/** Returns the model's parameter that a command changes, and its value: {name, unit, value}; undefined if it changes none. */
function parameterOf(command) {
  const { fields } = changeOf(command) ?? {};
  const values = named(command);
  const given = fields ? fields.map(({ name }) => values[name]) : (command.data?.values ?? []);
  const live = session.peek()?.live?.find(
    ({ word, body, before: first }) => word === command.command && [null, command.data?.body].includes(body) && first.every((one, n) => one === given[n]),
  );
  return live && { ...live, value: given[live.before.length] };
}

/** Returns what a command sets, and to which value: {of, key, text, parameter}; null for a command that sets no value. */
function settingOf(command) {
  const parameter = command.command === "aperture" ? undefined : parameterOf(command);
  if (parameter) return { of: "parameter", key: `parameter ${parameter.name}`, text: valueText(parameter.value), parameter };
  const change = changeOf(command);
  if (!change) return null; // the names of its values are not known
  const { of } = change;
  const values = named(command);
  if (command.command === "aperture") return typeof values.width === "number" ? { of: "aperture", key: `aperture ${values.name}`, text: cm(values.width) } : null;
  if (of === "parameter") return { of, key: `parameter ${values.path}`, text: valueText(values.value) };
  if (of === "buffer") return { of, key: `buffer ${values.buffer}`, text: values.chunk ?? "empty" };
  if (command.command === "move") return { of: "place", key: `move ${values.object}`, text: placeText(values) };
  return null;
}

function placeText({ x, y, heading }) {
  const turned = typeof heading === "number" ? `, ${((180 / Math.PI) * heading).toFixed(0)}°` : "";
  return `(${valueText(x)}, ${valueText(y)}) m${turned}`;
}

/** Returns a command as text, without its name. */
function dataText(event) {
  const command = event[3];
  const setting = settingOf(command);
  const values = named(command);
  if (setting) {
    const was = before.has(event) ? `${before.get(event)} -> ` : "";
    if (setting.of === "aperture") return `${values.name === "aperture" ? "" : `${values.name} `}${was}${setting.text} cm`;
    if (setting.parameter) return `${was}${setting.text}${setting.parameter.unit ? ` ${setting.parameter.unit}` : ""}`;
    if (setting.of === "place") return `${values.object} to ${setting.text}`;
    return `${values.buffer ?? values.path} ${was}${setting.text}`;
  }
  const { text } = changeOf(command) ?? {};
  if (text) return text.replace(/\{(\w+)\}/g, (_, name) => valueText(values[name]));
  const { data } = command;
  const more = Object.entries(data?.named ?? {}).map(([name, value]) => `${name}: ${valueText(value)}`);
  return [...(data?.body ? [data.body] : []), ...(data?.values ?? []).map(valueText), ...more].join(" ");
}

/** Returns [name, arguments] of a command. */
export function commandText(event) {
  const { command } = event[3];
  const { parameter } = settingOf(event[3]) ?? {};
  if (parameter) return [parameter.name, dataText(event)];
  return [changeOf(event[3]) && command !== "aperture" ? command.replaceAll("_", " ") : command, dataText(event)];
}

/** Returns the key of what a command sets; the simulations of a program have things of the same name. */
const keyOf = ([, source], { key }) => `${source} ${key}`;

/** Whether a command comes from a user: a program can give its simulations commands itself. */
export function isOfUser([, , , { by }]) {
  return session.peek()?.kind !== "program" || by === "user";
}
