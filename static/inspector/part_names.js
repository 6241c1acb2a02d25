// The names of the components of activations, and the format of their numbers in columns.

import { html } from "../vendor/preact.js";
import { NAMES } from "../activation_parts.js";
import { valueText } from "../parts/chunk.js";

/** Returns the name of a component of an activation. */
export function partName(part) {
  const [, name, number] = /^(.*?)( \d+)?$/.exec(part);
  return (NAMES[name] ?? name) + (number ?? "");
}

/** Returns a number with three decimals, so that a column of them can be compared. */
export function fixed(value) {
  return typeof value === "number" ? value.toFixed(3) : valueText(value);
}

/** Returns a component of a utility or an activation as text; noise that is drawn only when needed is not known before. */
export function Part({ value }) {
  if (value !== null && value !== undefined) return html`<span title=${value}>${fixed(value)}</span>`;
  return html`<span class="quiet" title="Drawn only when it is needed, or known only to the model's own code">not drawn</span>`;
}
