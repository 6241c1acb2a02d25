// The open texts: each with its history, the file's text when it was read, and what is known of the file now.

import { signal } from "../vendor/preact.js";
import { listModels } from "../bar/models.js";
import { call } from "../server.js";
import { notify } from "../store.js";
import { freshState, watchText } from "./code.js";
import * as drafts from "./drafts.js";
import { marksOf, sameMarks } from "./marks.js";

/** The maximum size of a model file [bytes]; the server rejects larger ones. */
export const LARGEST = 1_000_000;
const KEPT_AFTER = 300; // the delay after a change before the draft is stored [ms]

/** The open texts, by path. */
export const documents = signal(new Map());
/** The text that is shown: its path, and the error if it cannot be shown. */
export const shown = signal({ path: null, error: null });
/** A line to go to when its text is shown: {path, line}. */
export const wanted = signal(null);

/** Returns the text that is shown; null if there is none. */
export function shownDocument() {
  return documents.value.get(shown.value.path) ?? null;
}

/** Called with each text that is opened or has changed. */
export const watching = { changed: () => {} };

/** One open text. */
class Document {
  constructor(path, text, base, version) {
    this.path = path;
    /** The editor's state: text, history, selection, marks. */
    this.state = freshState(base ?? text);
    /** The file's text from which this one was edited, as an editor document; null if unknown. */
    this.base = base === null ? null : this.state.doc;
    this.version = version;
    /** The changes from `base` to the text, for finding lines of the file in it. */
    this.since = this.state.changes([]);
    this.scroll = 0;
    /** A position to scroll to when the text becomes visible; null for none. */
    this.revealed = null;
    this.saving = signal(false);
    /** The latest save: a promise of whether the file was written. */
    this.saved = Promise.resolve(true);
    this.dirty = signal(base === null);
    /** The file's text if this text was not edited from it: {text, version}; {text: null} if the file no longer exists. */
    this.theirs = signal(null);
    this.marks = signal([]);
    /** The latest action, in a few words; empty once the text has changed after it. */
    this.note = signal("");
    /** Where a word stays after it was renamed elsewhere: {word, places, starts}, with the starts of these lines; null for nowhere. */
    this.unchanged = signal(null);
    if (base !== null && text !== base) this.change(minimal(this.state, text));
  }

  /** Stores an update of the editor, or applies it if this text is not in the editor. */
  took(transactions) {
    const before = marksOf(this.state).length;
    this.state = transactions.at(-1).state;
    if (transactions.some(({ docChanged }) => docChanged)) {
      for (const { changes } of transactions) this.since = this.since.compose(changes);
      this.note.value = "";
      if (this.unchanged.value) this.unchanged.value = transactions.reduce(moved, this.unchanged.value);
      this.settle();
      keepSoon(this);
      watching.changed(this);
      if (marksOf(this.state).length < before) return this.change(sameMarks(this.state));
    }
    this.marks.value = marksOf(this.state);
  }

  change(spec) {
    if (!watchText.dispatch(this, spec)) this.took([this.state.update(spec)]);
  }

  settle() {
    this.dirty.value = this.base === null || !this.state.doc.eq(this.base);
  }

  /** Marks a text as that of the file. */
  based(text, version) {
    this.base = this.state.toText(text);
    this.version = version;
    this.theirs.value = null;
    this.settle();
    keepSoon(this);
  }

  get text() {
    return this.state.doc.toString();
  }
}

/** Returns where a word stays unchanged, after a transaction: nowhere once the renaming may be undone. */
function moved(unchanged, transaction) {
  if (!unchanged || transaction.isUserEvent("undo")) return null;
  return { ...unchanged, starts: unchanged.starts.map((at) => transaction.changes.mapPos(at, 1)) };
}

/** Returns the change from a state to another text, without the equal parts at both ends. */
function minimal(state, text) {
  const now = state.doc.toString();
  let from = 0;
  while (from < Math.min(now.length, text.length) && now[from] === text[from]) from += 1;
  let same = 0;
  while (same < Math.min(now.length, text.length) - from && now[now.length - 1 - same] === text[text.length - 1 - same]) same += 1;
  return { changes: { from, to: now.length - same, insert: text.slice(from, text.length - same) } };
}

// -- unsaved work

const timers = new Map();

function keepSoon(document) {
  clearTimeout(timers.get(document));
  timers.set(document, setTimeout(keepNow, KEPT_AFTER, document));
}

function keepNow(document) {
  clearTimeout(timers.get(document));
  timers.delete(document);
  if (documents.peek().get(document.path) !== document) return;
  if (document.dirty.peek()) drafts.keep(document.path, document.text, document.version);
  else drafts.forget(document.path);
}

function keepAll() {
  for (const document of [...timers.keys()]) keepNow(document);
}

/** The files with unsaved work in this tab; including those not opened since the page was reloaded. */
export function unsaved() {
  const dirty = [...documents.value.values()].filter((document) => document.dirty.value).map(({ path }) => path);
  return [...new Set([...dirty, ...drafts.drafted.value.filter((path) => !documents.value.has(path))])];
}

addEventListener("pagehide", keepAll);
addEventListener("beforeunload", (event) => {
  keepAll();
  if ([...documents.peek().values()].some((document) => document.dirty.peek())) event.preventDefault();
});

// -- opening and closing

/** Shows a model file in the editor, and opens it if necessary. Runs nothing. The latest request counts. */
export async function open(path, line = null) {
  shown.value = { path, error: null };
  wanted.value = line ? { path, line } : null;
  if (documents.value.has(path)) {
    look(documents.value.get(path)).catch(() => {});
    return;
  }
  await drafts.ready;
  const draft = drafts.read(path);
  let file = null;
  let error = null;
  try {
    file = await call("GET", `/api/model?path=${encodeURIComponent(path)}`);
  } catch (failed) {
    error = failed;
  }
  if (!documents.value.has(path)) {
    if (file || (draft && error.status === 404)) put(made(path, file, draft));
    else {
      if (wanted.value?.path === path) wanted.value = null;
      if (shown.value.path === path) shown.value = { path, error: error.message };
    }
  }
}

function made(path, file, draft) {
  if (!draft) return new Document(path, file.text, file.text, file.version);
  const same = file && (file.version === draft.version || file.text === draft.text);
  if (same) return Object.assign(new Document(path, draft.text, file.text, file.version), { restored: true });
  const document = new Document(path, draft.text, null, draft.version);
  document.theirs.value = file ? { text: file.text, version: file.version } : { text: null, version: null };
  return document;
}

function put(document) {
  documents.value = new Map([...documents.value, [document.path, document]]);
  document.note.value = document.restored ? "brought back from an earlier visit" : "";
  watching.changed(document);
}

/** Removes a text whose file was deleted or renamed. */
export function close(path) {
  documents.value = new Map([...documents.value].filter(([other]) => other !== path));
  drafts.forget(path);
  if (shown.value.path === path) shown.value = { path: null, error: null };
}

/** Gives an open text the new name of its file. */
export function renamed(path, file) {
  const document = documents.value.get(path);
  if (!document) return;
  drafts.forget(path);
  Object.assign(document, { path: file.path, version: file.version });
  documents.value = new Map([...documents.value].map(([, one]) => [one.path, one]));
  if (shown.value.path === path) shown.value = { path: file.path, error: null };
  keepSoon(document);
}

// -- the file

/** Writes a text to its file; returns whether it was written. If the file has changed meanwhile, reports that and writes nothing; a file
 * that is gone is made again.
 * `over` is the version to replace; by default the one that the text was edited from. Only one save at a time: a second save
 * during the first would take the first one's text for somebody else's. */
export function save(document, over = undefined) {
  document.saved = document.saved.then(() => saveNow(document, over));
  return document.saved;
}

async function saveNow(document, over) {
  if (new TextEncoder().encode(document.text).length > LARGEST) {
    notify(`${document.path} was not saved: the size of a model file must be <= ${LARGEST.toLocaleString("en")} bytes.`);
    return false;
  }
  document.saving.value = true;
  try {
    if (over !== undefined) return await write(document, over);
    await look(document, true).catch(() => {}); // a conflict should be visible before the save
    const theirs = document.theirs.value;
    return (theirs === null || theirs.text === null) && (await write(document, theirs ? null : document.version));
  } finally {
    document.saving.value = false;
  }
}

async function write(document, over) {
  const sent = document.state.doc;
  const text = sent.toString();
  const before = document.since;
  document.since = document.state.changes([]);
  try {
    const { version } = await call("PUT", "/api/model", { path: document.path, text, version: over });
    Object.assign(document, { base: sent, version });
    document.theirs.value = null;
    document.note.value = "saved";
    document.settle();
    keepNow(document);
    if (over === null) listModels().catch(() => {}); // a new file
    return true;
  } catch (error) {
    document.since = before.compose(document.since);
    if (error.status === 409) await look(document, true).catch(() => {});
    if (!document.theirs.value) notify(error.message);
    return false;
  }
}

/** Checks the file for changes. An unedited text is replaced by the file's; for an edited one, the user must choose. */
export async function look(document, again = false) {
  if (document.saving.value && !again) return;
  const known = document.version;
  const path = document.path;
  const query = `path=${encodeURIComponent(path)}`;
  const { version } = await call("GET", `/api/model/version?${query}`);
  const theirs = document.theirs.value;
  if (version === (theirs ? theirs.version : known)) return;
  const file = version === null ? { text: null, version: null } : await call("GET", `/api/model?${query}`);
  if (document.version !== known || document.path !== path || (document.saving.value && !again)) return; // saved or renamed meanwhile
  if (file.version === known) document.theirs.value = null;
  else if (file.text !== null && (!document.dirty.value || file.text === document.text)) take(document, file);
  else {
    document.theirs.value = { text: file.text, version: file.version };
    document.note.value = ""; // it was true of the former file
  }
}

/** Replaces the text by the file's; this can be undone. */
export function take(document, { text, version }) {
  document.change(minimal(document.state, text));
  document.based(text, version);
  document.since = document.state.changes([]);
  document.note.value = "read again: the file had changed";
}
