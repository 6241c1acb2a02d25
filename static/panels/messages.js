// What the user is told: errors with their lines, warnings, what the model's process prints.

import { html, signal, useEffect } from "../vendor/preact.js";
import { notices } from "../store.js";

const seen = signal(0); // how many errors had been told when the tab was last open

function errors() {
  return notices.value.filter(({ level }) => level === "error").length;
}

function Messages() {
  useEffect(() => void (seen.value = errors()));
  if (notices.value.length === 0) return html`<p class="empty">No messages. What goes wrong in a model is told here, with its line.</p>`;
  return html`<ol id="log" class="log" aria-live="polite">
    ${notices.value.toReversed().map(
      ({ number, level, text, file, line, detail }) => html`<li key=${number} class=${level}>
        ${file ? html`<span class="place">${file}:${line}</span>` : null}
        <span class="text">${text}</span>
        ${detail && detail.trim() !== text ? html`<details><summary>Traceback</summary><pre>${detail}</pre></details>` : null}
      </li>`,
    )}
  </ol>`;
}

export const messages = {
  id: "messages",
  title: "Messages",
  View: Messages,
  badge: () => (errors() > seen.value ? { text: String(errors() - seen.value), level: "bad" } : null),
};
