// What can be done with the name at the cursor, and with the whole text: go to the definition, rename, format.

import { diff } from "../vendor/codemirror.js";
import { asked } from "../parts/dialog.js";
import { counted } from "../parts/count.js";
import { notify } from "../store.js";
import { focusText, goToPosition } from "./code.js";
import { open } from "./documents.js";
import { askAbout } from "./language.js";

/** Asks about the text that is shown, at the cursor; complains if there is no answer, and returns null then. */
async function answered(document, ask, name) {
  try {
    return await askAbout(document.state, ask, document.state.selection.main.head, name);
  } catch (error) {
    notify(error.message, "error", null, error.line ? { file: document.path, line: error.line } : {});
    return null;
  }
}

/** Goes to where the name at the cursor is defined, also in another file of the folder. */
export async function define(document) {
  const { doc } = document.state;
  const found = await answered(document, "define");
  if (!found) return say(document, "there is no name here whose definition is known");
  if (found.path === null) return say(document, `${found.name} comes from ${found.module}: point at the name to read its documentation`);
  if (found.at === null) return open(found.path, found.line);
  if (document.state.doc === doc) goToPosition(found.at);
}

function say(document, text) {
  document.note.value = text;
}

/** Renames the name at the cursor in the whole text, after asking for the new name; this can be undone. */
export async function rename(document) {
  const { state } = document;
  const found = await answered(document, "rename");
  if (!found) return;
  let problem = null;
  let name = found.name;
  for (;;) {
    const title = `Rename the ${found.what} ${found.name} in ${counted(found.changes.length, "place")}`;
    name = await asked(title, "New name", name, "Rename", { problem });
    if (!name || name === found.name) return focusText();
    try {
      const { changes, unchanged } = await askAbout(state, "rename", state.selection.main.head, name);
      if (document.state.doc !== state.doc) return notify("Nothing was renamed: the text has changed meanwhile.");
      document.change({ changes: changes.map(([from, to]) => ({ from, to, insert: name })), userEvent: "input.rename" });
      const starts = unchanged.map((line) => document.state.doc.line(line).from);
      document.unchanged.value = starts.length > 0 ? { word: found.name, places: changes.length, starts } : null;
      if (starts.length === 0) say(document, `renamed in ${counted(changes.length, "place")}`);
      return focusText();
    } catch (error) {
      problem = error.message;
    }
  }
}

/** Writes the text as `ruff format` does; this can be undone. */
export async function format(document) {
  const { doc } = document.state;
  const found = await answered(document, "format");
  if (!found || document.state.doc !== doc) return;
  const before = doc.toString();
  const changes = diff(before, found.text, { scanLimit: 500, timeout: 300 }).map(({ fromA, toA, fromB, toB }) => ({ from: fromA, to: toA, insert: found.text.slice(fromB, toB) }));
  if (changes.length > 0) document.change({ changes, userEvent: "input.format" });
  say(document, changes.length > 0 ? "formatted" : "it is formatted already");
}
