// A line of a file, as a link that opens it in the editor; and tracebacks, whose lines are such links.

import { html } from "../vendor/preact.js";
import { folder } from "../bar/models.js";
import { open } from "../editor/documents.js";
import { hasMore } from "../editor/marks.js";
import { isAvailable } from "../needs.js";
import { openTab } from "../open_tab.js";

const PLACE = /^(\s*File ")(.+)(", line )(\d+)(.*)$/;

/** Opens a model file in the editor, at a line. */
export function openAt(path, line) {
  openTab.value = "editor";
  return open(path, line);
}

/** Returns the name of a file in the models folder; null if it is not there. */
function inFolder(file) {
  if (!isAvailable("models folder")) return null;
  const root = `${folder.value}/`;
  if (folder.value && file.startsWith(root)) return file.slice(root.length);
  return file.startsWith("/") || file.startsWith("<") || /^\w:/.test(file) ? null : file;
}

export function Place({ file, line }) {
  const path = inFolder(file);
  const text = line ? `${path ?? file}:${line}` : path ?? file;
  if (!path?.endsWith(".py")) return html`<span class="place">${text}</span>`;
  return html`<button class="place link" title="Open in the editor" onClick=${() => openAt(path, line)}>${text}</button>`;
}

/** The traceback of a problem, if it has more than the message, with links to the lines of the folder's files. */
export function Traceback({ message, detail }) {
  if (!hasMore({ message, detail })) return null;
  return html`<details><summary>Traceback</summary><pre>
${detail
      .trimEnd()
      .split("\n")
      .map((line) => {
        const found = PLACE.exec(line);
        const path = found && inFolder(found[2]);
        if (!path?.endsWith(".py")) return `${line}\n`;
        const [, before, , between, number, after] = found;
        return html`${before}<button class="place link" onClick=${() => openAt(path, Number(number))}>${path}</button>${between}${number}${after}${"\n"}`;
      })}</pre
  ></details>`;
}
