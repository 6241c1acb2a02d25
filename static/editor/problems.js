// The problems of a text as a list; choosing one goes to its line.

import { html } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { counted } from "../parts/count.js";
import { Traceback } from "../parts/place.js";
import { remembered } from "../local_storage.js";
import { goToLine } from "./code.js";

const folded = remembered("problems folded", false);
const SIGNS = { error: "✕", warning: "▲", info: "●" }; // the worst first

export function Problems({ document }) {
  const marks = document.marks.value;
  const counts = Object.keys(SIGNS).map((level) => [level, marks.filter((mark) => mark.level === level).length]);
  const said = counts.filter(([, count]) => count > 0).map(([level, count]) => counted(count, level));
  const worst = marks.length === 0 ? "quiet" : { error: "bad", warning: "warning", info: "" }[counts.find(([, count]) => count > 0)[0]];
  return html`<section class="problems" aria-label="Problems">
    <div class="head">
      <${Button} class="bare" aria-expanded=${!folded.value} disabled=${marks.length === 0} onClick=${() => (folded.value = !folded.value)}>
        <span class=${worst}>${said.join(", ") || "No problems"}</span>
      <//>
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

function Problem({ mark }) {
  const { level, message, detail, line, origin } = mark;
  return html`<li class=${level}>
    <${Button} class="bare" disabled=${line === null} onClick=${() => goToLine(line)}>
      <span class=${level === "error" ? "bad" : level} role="img" aria-label=${level}>${SIGNS[level]}</span>
      <span class="number">${line === null ? "" : `line ${line}`}</span>
      <span class="text">${message}</span>
      ${origin === "run" ? html`<span class="quiet">the run</span>` : null}
    <//>
    <${Traceback} message=${message} detail=${detail} />
  </li>`;
}
