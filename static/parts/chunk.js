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
  if (!chunk) return "";
  return slotsOf(chunk)
    .map(([slot, text]) => (slot ? `${slot}:${text}` : text))
    .join(" ");
}

/** Returns a chunk as a model writes it, with full numbers; a slot that is not where its number says is named. */
export function writtenChunk(chunk) {
  const exact = (value) => (typeof value === "number" ? String(value) : valueText(value));
  return Object.entries(chunk ?? {})
    .map(([slot, value], place) => (slot === String(place) ? exact(value) : `${slot}:${exact(value)}`))
    .join(" ");
}

export function Chunk({ chunk }) {
  if (!chunk) return html`<span class="empty">empty</span>`;
  return html`<span class="chunk">
    ${slotsOf(chunk).map(([slot, text], n) => html`<span class="slot" key=${n}>${slot ? html`<b>${slot}</b>` : null}${text}</span>`)}
  </span>`;
}
