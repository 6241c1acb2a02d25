// What is marked in a text: what a check says of it, and what a run has said, at their lines as these move.

import { setDiagnostics, StateEffect, StateField } from "../vendor/codemirror.js";

const MOST_RUN = 100; // marks of a run in one text

/** Puts marks of one origin ("check" or "run") in place of those there are: {origin, marks}. */
const putMarks = StateEffect.define();

/** The marks of a text: {origin, level, message, detail, from, to}; `from` is null for what has no line. */
const marksField = StateField.define({
  create: () => [],
  update(marks, transaction) {
    let now = marks;
    if (transaction.docChanged) now = now.map((mark) => moved(mark, transaction)).filter(Boolean);
    for (const effect of transaction.effects) {
      if (effect.is(putMarks)) now = [...now.filter(({ origin }) => origin !== effect.value.origin), ...effect.value.marks];
    }
    return now;
  },
});

/** What a run said of a line holds until that line is changed; what a check said is checked anew anyway. */
function moved(mark, { changes, startState, newDoc }) {
  if (mark.from === null) return mark;
  const line = startState.doc.lineAt(mark.from);
  if (mark.origin === "run" && changes.touchesRange(line.from, line.to) && changesText(changes, line)) return null;
  const at = newDoc.lineAt(Math.min(changes.mapPos(mark.from, 1), newDoc.length));
  return { ...mark, from: start(at), to: at.to };
}

/** Whether a line's own text changes, not only what stands before or behind it. */
function changesText(changes, line) {
  let does = false;
  changes.iterChanges((from, to, _, __, inserted) => {
    const before = to <= line.from && (inserted.length === 0 || inserted.line(inserted.lines).length === 0);
    const behind = from >= line.to && (inserted.length === 0 || inserted.line(1).length === 0);
    const whole = to > line.to && from <= line.from;
    if (from <= line.to && to >= line.from && !before && (!behind || whole)) does = true;
  });
  return does;
}

function start(line) {
  return line.from + (line.text.length - line.text.trimStart().length);
}

export const marking = marksField;

/** Whether there is more to tell than the message. */
export const hasMore = ({ message, detail }) => detail.trim().includes("\n") && detail.trim() !== message.trim();

/** Returns marks without those that say again what another one says at that line; a run tells more than a check. */
function distinct(marks) {
  const last = new Map(marks.toSorted((one, other) => (one.origin < other.origin ? -1 : 1)).map((mark) => [`${mark.from} ${mark.message}`, mark]));
  return [...last.values()];
}

/** Returns the marks of a state, with their line numbers, first those that come first in the text. */
export function marksOf(state) {
  return distinct(state.field(marksField))
    .map((mark) => ({ ...mark, line: mark.from === null ? null : state.doc.lineAt(mark.from).number }))
    .sort((one, other) => (one.line ?? 0) - (other.line ?? 0));
}

/** Returns the mark of a problem at a line of a text. */
export function markAt(doc, origin, { level, message, detail = "", line }) {
  if (!line || line > doc.lines) return { origin, level, message, detail, from: null, to: null };
  const place = doc.line(line);
  return { origin, level, message, detail, from: start(place), to: place.to };
}

/** Returns the transaction that puts marks of an origin into a state. */
export function withMarks(state, origin, marks) {
  const list = origin === "run" ? marks.slice(-MOST_RUN) : marks;
  const all = [...state.field(marksField).filter((mark) => mark.origin !== origin), ...list];
  const shown = setDiagnostics(state, diagnostics(all));
  return { ...shown, effects: [shown.effects ?? [], putMarks.of({ origin, marks: list })].flat() };
}

/** Returns the transaction that shows the marks that are left, after others have gone. */
export function sameMarks(state) {
  return setDiagnostics(state, diagnostics(state.field(marksField)));
}

function diagnostics(marks) {
  return distinct(marks)
    .filter(({ from }) => from !== null)
    .map(diagnostic)
    .sort((one, other) => one.from - other.from);
}

function diagnostic(mark) {
  const { origin, level, message, from, to } = mark;
  return { from, to, severity: level, message, source: origin === "run" ? "the run" : undefined, renderMessage: () => written(mark) };
}

/** Writes a message and its traceback, as text. */
function written(mark) {
  const box = document.createElement("div");
  const text = document.createElement("div");
  text.className = "told";
  text.textContent = mark.message;
  box.append(text);
  if (hasMore(mark)) {
    const trace = document.createElement("pre");
    trace.textContent = mark.detail.trimEnd();
    box.append(trace);
  }
  return box;
}
