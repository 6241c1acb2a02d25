// Users' changes as text: `aperture 50 -> 40 cm`.

import { valueText } from "../parts/chunk.js";
import { session } from "../store.js";

const before = new WeakMap(); // by event: the previous width [m]

/** Stores the widths of apertures, from event to event. */
export class Widths {
  #widths = new Map();

  /** Stores the effect of a command; called in order. */
  take(event) {
    const change = changeOf(event[3]);
    if (!change) return;
    const known = this.#widths.get(change.name) ?? session.peek()?.world?.openings?.[change.name];
    if (known !== undefined) before.set(event, known);
    this.#widths.set(change.name, change.width);
  }
}

/** Returns {name, width} of the aperture that a command changes; null for other commands. */
function changeOf({ command, data }) {
  if (command !== "aperture" || typeof data?.values?.[0] !== "number") return null;
  return { name: data.named?.name ?? "aperture", width: data.values[0] };
}

const cm = (width) => String(Number((100 * width).toFixed(1)));

/** Returns a command as text, without its name. With `first`, it covers all commands from that one on, for example of one drag. */
function dataText(event, first) {
  const [, , , { data }] = event;
  const change = changeOf(event[3]);
  if (change) {
    const other = change.name === "aperture" ? "" : `${change.name} `;
    return `${other}${before.has(first) ? `${cm(before.get(first))} -> ` : ""}${cm(change.width)} cm`;
  }
  const named = Object.entries(data?.named ?? {}).map(([name, value]) => `${name}: ${valueText(value)}`);
  return [...(data?.values ?? []).map(valueText), ...named].join(" ");
}

/** Returns [name, arguments] of a command. */
export function commandText(event, first = event) {
  return [event[3].command, dataText(event, first)];
}

/** Whether two commands set the same value. */
export function setTheSame(event, other) {
  const [one, two] = [changeOf(event[3]), changeOf(other[3])];
  return one !== null && two !== null && one.name === two.name;
}
