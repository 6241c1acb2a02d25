// What is wrong with a text, as a list; choosing one goes to its line.

import { html } from "../vendor/preact.js";
import { Traceback } from "../parts/place.js";
import { remembered } from "../remembered.js";
import { goTo } from "./code.js";

const folded = remembered("problems folded", false);
const SIGNS = { error: "✕", warning: "▲", info: "●" };

export function Problems({ document }) {
  const marks = document.marks.value;
  const count = (level) => marks.filter((mark) => mark.level === level).length;
  const [errors, warnings] = [count("error"), count("warning")];
  const text = marks.length === 0 ? "No problems" : `${errors} ${errors === 1 ? "error" : "errors"}, ${warnings} ${warnings === 1 ? "warning" : "warnings"}`;
  return html`<section class="problems" aria-label="Problems">
    <div class="head">
      <button class="bare" aria-expanded=${!folded.value} disabled=${marks.length === 0} onClick=${() => (folded.value = !folded.value)}>
        <span class=${errors ? "bad" : warnings ? "warning" : "quiet"}>${text}</span>
      </button>
      <span class="stretch"></span>
      <span class="quiet hint">Esc then Tab leaves the text</span>
    </div>
    ${folded.value || marks.length === 0
      ? null
      : html`<ul>
          ${marks.map((mark, n) => html`<${Problem} key=${n} mark=${mark} />`)}
        </ul>`}
  </section>`;
}

function Problem({ mark: { level, message, detail, line, origin } }) {
  const trace = detail.trim() && detail.trim() !== message.trim();
  return html`<li class=${level}>
    <button class="bare" disabled=${line === null} onClick=${() => goTo(line)}>
      <span class=${level === "error" ? "bad" : level} role="img" aria-label=${level}>${SIGNS[level]}</span>
      <span class="number">${line === null ? "" : `line ${line}`}</span>
      <span class="text">${message}</span>
      ${origin === "run" ? html`<span class="quiet">the run</span>` : null}
    </button>
    ${trace ? html`<details><summary>Traceback</summary><${Traceback} text=${detail} /></details>` : null}
  </li>`;
}
