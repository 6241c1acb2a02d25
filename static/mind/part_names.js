// What the parts of activations are called, and how their numbers stand in columns.

import { html } from "../vendor/preact.js";
import { valueText } from "../parts/chunk.js";

/** What modules of the library add to an activation, as people call it. */
const NAMES = {
  DMBaseLevel: "base level",
  DMFixed: "fixed",
  DMSpreading: "spreading",
  DMSalience: "salience",
  DMAssociate: "association",
  DMInhibition: "inhibition",
  DMNoise: "noise",
  partial: "partial match",
};

/** Returns what a part of an activation is called. */
export function partName(part) {
  const [, name, number] = /^(.*?)( \d+)?$/.exec(part);
  return (NAMES[name] ?? name) + (number ?? "");
}

/** Says a number with three digits after the point, so that a column of them can be compared. */
export function fixed(value) {
  return typeof value === "number" ? value.toFixed(3) : valueText(value);
}

/** Says a part of a utility or an activation; what is drawn by lot only when it is needed is not known before. */
export function Part({ value }) {
  if (value !== null && value !== undefined) return html`<span title=${value}>${fixed(value)}</span>`;
  return html`<span class="quiet" title="Drawn only when it is needed, or known only to the model's own code">not drawn</span>`;
}
