// Where a word stays after it was renamed elsewhere: as another name, or in a text or comment.

import { html } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { counted } from "../parts/count.js";
import { goToLine } from "./code.js";

const MOST = 8; // lines that are listed

/** @param document The text that is shown. */
export function Unchanged({ document }) {
  const found = document.unchanged.value;
  if (!found) return null;
  const { doc } = document.state;
  const lines = [...new Set(found.starts.map((at) => doc.lineAt(at).number))];
  const listed = lines.slice(0, MOST);
  const more = lines.length - listed.length;
  const between = (n) => (n === 0 ? "" : n === listed.length - 1 && more === 0 ? " and " : ", ");
  return html`<div class="strip" role="status">
    <span>
      Renamed in ${counted(found.places, "place")}. The word <code>${found.word}</code> stays in ${lines.length === 1 ? "line" : "lines"}${" "}
      ${listed.map((line, n) => html`${between(n)}<button class="link" aria-label="line ${line}" onClick=${() => goToLine(line)}>${line}</button>`)}${more > 0 ? ` and ${more} more` : ""}.
    </span>
    <${Button} class="bare" aria-label="Close" onClick=${() => (document.unchanged.value = null)}>✕<//>
  </div>`;
}
