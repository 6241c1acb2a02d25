// Docstrings and help texts: what they have in backticks is code.

import { html } from "../vendor/preact.js";

/** A text in a line. */
export function Inline({ text }) {
  return text.split(/`([^`\n]+)`/).map((part, n) => (n % 2 ? html`<code key=${n}>${part}</code>` : part));
}

/** Returns a text for a place that shows no code, such as a title: without the backticks. */
export const plain = (text) => text.replaceAll("`", "");

/** @param text The docstring; paragraphs after the first are quiet. */
export function Prose({ text }) {
  return text.split("\n\n").map((paragraph, n) => html`<p key=${n} class=${n ? "quiet" : ""}><${Inline} text=${paragraph} /></p>`);
}
