// What users changed, as one reads it: `aperture 50 -> 40 cm`.

import { valueText } from "../parts/chunk.js";
import { session } from "../store.js";

const before = new WeakMap(); // by event: the width that it changed [m]

/** Knows the widths of apertures, from event to event. */
export class Widths {
  #widths = new Map();

  /** Takes note of a command, in the order in which they come. */
  take(event) {
    const change = changeOf(event[3]);
    if (!change) return;
    const known = this.#widths.get(change.name) ?? session.peek()?.world?.openings?.[change.name];
    if (known !== undefined) before.set(event, known);
    this.#widths.set(change.name, change.width);
  }
}

/** Returns {name, width} of the aperture that a command changes; null of another command. */
function changeOf({ command, data }) {
  if (command !== "aperture" || typeof data?.values?.[0] !== "number") return null;
  return { name: data.named?.name ?? "aperture", width: data.values[0] };
}

const cm = (width) => String(Number((100 * width).toFixed(1)));

/** Says a command, after its word. With `first` it is that one and all up to this, as of one drag. */
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

/** Returns [word, with what] of a command. */
export function commandText(event, first = event) {
  return [event[3].command, dataText(event, first)];
}

/** Whether two commands set the same. */
export function setTheSame(event, other) {
  const [one, two] = [changeOf(event[3]), changeOf(other[3])];
  return one !== null && two !== null && one.name === two.name;
}
