// A docstring as paragraphs: what it has in backticks is code.

import { html } from "../vendor/preact.js";

function Line({ text }) {
  return text.split(/`([^`\n]+)`/).map((part, n) => (n % 2 ? html`<code key=${n}>${part}</code>` : part));
}

/** @param text The docstring; paragraphs after the first are quiet. */
export function Prose({ text }) {
  return text.split("\n\n").map((paragraph, n) => html`<p key=${n} class=${n ? "quiet" : ""}><${Line} text=${paragraph} /></p>`);
}
