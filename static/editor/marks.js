// The marks in a text: problems found by a check or reported by a run, at lines that move with the text.

import { setDiagnostics, StateEffect, StateField } from "../vendor/codemirror.js";

const MAX_RUN = 100; // marks of a run in one text

/** Replaces the marks of one origin ("check" or "run"): {origin, marks}. */
const putMarks = StateEffect.define();

/** The marks of a text: {origin, level, message, detail, from, to}; `from` is null for marks without a line. Those of a run have the
 * `keys` of their notices. */
export const marking = StateField.define({
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

/** A run's mark is valid until its line is changed; a text is checked again anyway. */
function moved(mark, { changes, startState, newDoc }) {
  if (mark.from === null) return mark;
  const line = startState.doc.lineAt(mark.from);
  if (mark.origin === "run" && changes.touchesRange(line.from, line.to) && changesText(changes, line)) return null;
  const at = newDoc.lineAt(Math.min(changes.mapPos(mark.from, 1), newDoc.length));
  return { ...mark, from: start(at), to: at.to };
}

/** Whether a line's own text changes, not only the text before or after it. */
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

/** Whether there are more details than the message. */
export const hasMore = ({ message, detail }) => detail.trim().includes("\n") && detail.trim() !== message.trim();

/** Returns the line of a mark and the first name that its message quotes. */
const subjectOf = ({ from, message }) => `${from} ${/'([^']+)'/.exec(message)?.[1]}`;

/** Returns marks without duplicates of a message at a line; a run's mark, which has more details, is preferred. An error of the run also
 * replaces what the check says of the same name at its line. */
function distinct(all) {
  const failed = new Set(all.filter(({ origin, level }) => origin === "run" && level === "error").map(subjectOf));
  const marks = all.filter((mark) => mark.origin === "run" || !failed.has(subjectOf(mark)));
  const last = new Map(marks.toSorted((one, other) => (one.origin < other.origin ? -1 : 1)).map((mark) => [`${mark.from} ${mark.message}`, mark]));
  return [...last.values()];
}

/** Returns the marks of a state, with their line numbers, ordered by position. */
export function marksOf(state) {
  return distinct(state.field(marking))
    .map((mark) => ({ ...mark, line: mark.from === null ? null : state.doc.lineAt(mark.from).number }))
    .sort((one, other) => (one.line ?? 0) - (other.line ?? 0));
}

/** Returns the mark of a problem at a line of a text. */
export function markAt(doc, origin, { level, message, detail = "", line }) {
  if (!line || line > doc.lines) return { origin, level, message, detail, from: null, to: null };
  const place = doc.line(line);
  return { origin, level, message, detail, from: start(place), to: place.to };
}

/** Returns the transaction that adds marks of an origin to a state. */
export function withMarks(state, origin, marks) {
  const list = origin === "run" ? marks.slice(-MAX_RUN) : marks;
  const all = [...state.field(marking).filter((mark) => mark.origin !== origin), ...list];
  const shown = setDiagnostics(state, diagnostics(all));
  return { ...shown, effects: [shown.effects ?? [], putMarks.of({ origin, marks: list })].flat() };
}

/** Returns the transaction that shows the remaining marks after others were removed. */
export function sameMarks(state) {
  return setDiagnostics(state, diagnostics(state.field(marking)));
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

/** Returns a message and its traceback as text. */
function written(mark) {
  const box = document.createElement("div");
  const text = document.createElement("div");
  text.className = "shown-error";
  text.textContent = mark.message;
  box.append(text);
  if (hasMore(mark)) {
    const trace = document.createElement("pre");
    trace.textContent = mark.detail.trimEnd();
    box.append(trace);
  }
  return box;
}
