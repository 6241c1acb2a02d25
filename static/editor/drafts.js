// Unsaved work, stored in the browser so that it survives a reload: one draft per file and tab, with the version it was edited from.

import { signal } from "../vendor/preact.js";
import { ownName } from "../address.js";
import { notify } from "../store.js";

const PREFIX = "actr3d.draft.";
const LOCK = "actr3d.tab.";
const MAX_DRAFTS = 20;
const LARGEST = 2_000_000; // all drafts together [characters]; browsers store about five million per site

const keyOf = (path) => `${PREFIX}${ownName} ${path}`;

/** The files with a draft of this tab. */
export const drafted = signal([]);

/** Determines which drafts belong to this tab: its own from before a reload, and the newest of each file from closed tabs. If this tab
 * already has a draft of a file, the others stay, for a tab that has none. Without locks (a page over http from another machine), the
 * browser does not show which tabs are closed: then the tab has only its own drafts. */
export const ready = settle();

async function settle() {
  const { locks } = navigator;
  if (!locks) {
    refresh();
    return;
  }
  // The lock shows that the tab is open; it is not waited for, as the page before a reload may still have it.
  locks.request(LOCK + ownName, () => new Promise(() => {}));
  const held = (await locks.query()).held.map(({ name }) => name);
  for (const { key, draft } of all().reverse()) {
    const owner = key.slice(PREFIX.length).split(" ", 1)[0];
    if (owner === ownName || held.includes(LOCK + owner) || read(draft.path)) continue;
    localStorage.removeItem(key);
    write(keyOf(draft.path), draft);
  }
  refresh();
}

/** Returns all drafts of all tabs, the oldest first. */
function all() {
  const found = [];
  for (const key of Object.keys(localStorage).filter((name) => name.startsWith(PREFIX))) {
    try {
      const draft = JSON.parse(localStorage.getItem(key));
      if (typeof draft.path === "string" && typeof draft.text === "string") found.push({ key, draft });
    } catch {
      localStorage.removeItem(key);
    }
  }
  return found.sort((one, other) => one.draft.at - other.draft.at);
}

function refresh() {
  drafted.value = all().filter(({ key, draft }) => key === keyOf(draft.path)).map(({ draft }) => draft.path);
}

/** Returns the draft of a file: {path, text, version, at}, with the version of the file that it was edited from, and when it was stored [ms since
 * 1970]; null if there is none. */
export function read(path) {
  try {
    return JSON.parse(localStorage.getItem(keyOf(path)));
  } catch {
    return null;
  }
}

let warned = false;

/** Stores a draft; removes the oldest ones if there are too many. */
export function keep(path, text, version) {
  if (!write(keyOf(path), { path, text, version, at: Date.now() }) && !warned) {
    warned = true;
    notify(`The browser has no room to keep the unsaved text of ${path}: save it before you leave the page.`, "warning");
  }
  refresh();
}

function write(key, draft) {
  const others = all().filter((one) => one.key !== key);
  let size = others.reduce((sum, one) => sum + one.draft.text.length, draft.text.length);
  while (others.length >= MAX_DRAFTS || (size > LARGEST && others.length > 0)) size -= drop(others);
  for (;;) {
    try {
      localStorage.setItem(key, JSON.stringify(draft));
      return true;
    } catch {
      if (others.length === 0) return false;
      drop(others);
    }
  }
}

function drop(others) {
  const { key, draft } = others.shift();
  localStorage.removeItem(key);
  return draft.text.length;
}

/** Removes a draft that was saved or discarded. */
export function forget(path) {
  localStorage.removeItem(keyOf(path));
  refresh();
}
