// Chunks and values as text.

import { html } from "../vendor/preact.js";

/** Returns the slots of a chunk as [name, text]; positional slots have an empty name. */
export function slotsOf(chunk) {
  return Object.entries(chunk ?? {}).map(([slot, value]) => [/^\d+$/.test(slot) ? "" : slot, valueText(value)]);
}

/** Returns a value as text: numbers with at most four decimals, texts unchanged. */
export function valueText(value) {
  if (typeof value === "number") return Number.isInteger(value) ? String(value) : String(Number(value.toFixed(4)));
  if (value === null || value === undefined) return "none";
  return typeof value === "object" ? JSON.stringify(value) : String(value);
}

/** Returns a chunk in one line: positional slots first, then named ones. */
export function chunkText(chunk) {
  return slotsOf(chunk)
    .map(([slot, text]) => (slot ? `${slot}:${text}` : text))
    .join(" ");
}

/** Returns the text of a request as a model writes it: `0:count 1:?n` becomes `count ?n`. */
export function requestText(asked) {
  let next = 0;
  return asked.replace(/(?<=^|\s)(\d+):/g, (whole, slot) => (Number(slot) === next ? (next++, "") : whole));
}

/** Returns a chunk as a model writes it, with full numbers: a positional slot is the word at its place. */
export function writtenChunk(chunk) {
  const exact = (value) => (typeof value === "number" ? String(value) : valueText(value));
  const left = { ...chunk };
  const words = [];
  while (Object.keys(left).length > 0) {
    const named = Object.keys(left).find((slot) => !/^\d+$/.test(slot));
    const slot = String(words.length) in left ? String(words.length) : named ?? Object.keys(left)[0];
    words.push(slot === String(words.length) ? exact(left[slot]) : `${slot}:${exact(left[slot])}`);
    delete left[slot];
  }
  return words.join(" ");
}

export function Chunk({ chunk }) {
  if (!chunk) return html`<span class="empty">empty</span>`;
  return html`<span class="chunk">
    ${slotsOf(chunk).map(([slot, text], n) => html`<span class="slot" key=${n}>${slot ? html`<b>${slot}</b>` : null}${text}</span>`)}
  </span>`;
}
