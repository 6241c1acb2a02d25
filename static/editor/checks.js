// Problems in a text: checked during typing without running anything, by loading it on request, and as reported by a run.

import { effect, untracked } from "../vendor/preact.js";
import { folder } from "../bar/models.js";
import { call } from "../server.js";
import { isPresent, notices, notify, session } from "../store.js";
import { reveal } from "./code.js";
import { documents, LARGEST, watching } from "./documents.js";
import { markAt, marking, withMarks } from "./marks.js";

const AFTER = 350; // the delay after a change [ms]
const timers = new Map();
const checked = new WeakMap();

/** Checks a changed text after a pause in typing. */
watching.changed = (document) => {
  if (checked.get(document) === document.state.doc) return;
  clearTimeout(timers.get(document));
  timers.set(document, setTimeout(check, AFTER, document));
};

async function check(document) {
  const { doc } = document.state;
  if (doc.length > LARGEST) return;
  try {
    const { problems } = await call("POST", "/api/check", { path: document.path, text: doc.toString() });
    if (checked.get(document) !== doc) mark(document, doc, problems); // otherwise it was loaded meanwhile, which reports more
  } catch (error) {
    if (error.status !== 0) mark(document, doc, [{ level: "error", message: error.message, line: null }]);
  }
}

/** Loads a text in a separate process, which runs its top level and its `build`; a program without `build` is only compiled. */
export async function checkByLoading(document) {
  const { doc } = document.state;
  document.note.value = "being loaded …";
  try {
    const { problems, listing } = await call("POST", "/api/check", { path: document.path, text: doc.toString(), load: true });
    mark(document, doc, problems, { reveals: true });
    const fine = listing.kind === "simulation" ? "it loads, and nothing is wrong" : "nothing wrong was found without a run";
    document.note.value = problems.length === 0 && document.state.doc === doc ? fine : "";
  } catch (error) {
    document.note.value = "";
    notify(error.message);
  }
}

/** Shows the result of a check if the text has not changed since; if the user requested it, scrolls to the first error. */
function mark(document, doc, problems, { reveals = false } = {}) {
  if (document.state.doc !== doc) return;
  checked.set(document, doc);
  const marks = problems.map((problem) => markAt(doc, "check", problem));
  document.change(withMarks(document.state, "check", marks));
  if (reveals) revealFirst(document, marks);
}

// -- notices of a run

/** By text: the keys of the notices for which it has been marked. */
const taken = new WeakMap();

/** Marks the present notices in the open texts; removes the marks of others. */
effect(() => {
  const { id } = session.value ?? {};
  const present = new Map(notices.value.filter(isPresent).map((notice) => [`${id} ${notice.number}`, notice]));
  const open = [...documents.value.values()];
  untracked(() => {
    for (const document of open) take(document, present);
  });
});

function take(document, present) {
  const before = taken.get(document) ?? new Set();
  const fresh = [...present].filter(([key]) => !before.has(key));
  if (fresh.length === 0 && before.size === present.size) return;
  taken.set(document, new Set(present.keys()));
  const old = document.state.field(marking).filter(({ origin }) => origin === "run");
  const marks = old.map((mark) => ({ ...mark, keys: mark.keys.filter((key) => present.has(key)) })).filter(({ keys }) => keys.length > 0);
  const kept = marks.length;
  for (const [key, notice] of fresh) {
    const found = markOf(document, notice);
    const same = found && marks.find(({ from, message }) => from === found.from && message === found.message);
    if (same) same.keys.push(key);
    else if (found) marks.push({ ...found, keys: [key] });
  }
  if (old.length === 0 && marks.length === 0) return;
  document.change(withMarks(document.state, "run", marks));
  revealFirst(document, marks.slice(kept));
}

/** Scrolls the first error of some marks into view. */
function revealFirst(document, marks) {
  const found = marks.find(({ level, from }) => level === "error" && from !== null);
  if (found) reveal(document, found.from);
}

/** Returns the line of a file that a notice refers to, directly or through a call; null if there is none. */
function lineIn(path, { file, line, detail }) {
  if (file === path) return line;
  const start = `File "${folder.peek()}/${path}", line `;
  const at = detail.lastIndexOf(start);
  return at < 0 ? null : Number.parseInt(detail.slice(at + start.length), 10);
}

/** Returns the mark of a notice at the current position of its line; null if it belongs to another text, or the line was changed. */
function markOf(document, { level, text, detail, version, ...place }) {
  const line = lineIn(document.path, { ...place, detail });
  const other = document.path === session.peek()?.model && version !== document.version;
  if (line === null || document.base === null || other) return null;
  const mark = markAt(document.base, "run", { level, message: text, detail, line });
  if (mark.from === null) return mark;
  if (document.since.touchesRange(mark.from, mark.to)) return null;
  const at = document.state.doc.lineAt(document.since.mapPos(mark.from, 1));
  return { ...mark, from: document.since.mapPos(mark.from, 1), to: at.to };
}
