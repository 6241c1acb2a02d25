// The commands of the page, each registered once: the palette lists them, keys run them, the help and the titles of buttons name them.

import { isAvailable } from "./needs.js";

const known = [];
const sources = [];

/**
 * @typedef Command
 * @property {string} text What it does.
 * @property {() => string} about What it would act on now, for the palette; "" if there is nothing to add.
 * @property {string} also Other words by which the palette finds it.
 * @property {string} group The part of the page that it belongs to.
 * @property {string | null} key As in KeyboardEvent, preceded by "Shift+" or "Mod+" (Ctrl, or Cmd on a Mac); null for none.
 * @property {() => void} work Runs it.
 * @property {() => boolean} ready Whether it can be run now.
 * @property {() => string} why If it cannot be run: the reason, as a sentence, or "" if there is nothing to add.
 */

/** Registers a command, and returns it. It does not exist on a page without what it `needs` (needs.js): then nothing can run it. */
export function command({ text, about = () => "", also = "", group, key = null, work, ready = () => true, why = () => "", needs = null }) {
  const exists = isAvailable(needs);
  const made = { text, about, also, group, key, work, ready: exists ? ready : () => false, why };
  if (exists) known.push(made);
  return made;
}

/** Registers commands that depend on what is shown, which only a search finds.
 *
 * @param list Returns them for the words of a search, each time they are asked for.
 * @param read Reads what they are about, when the palette is opened.
 * @param needs Without this they do not exist, as in `command`.
 */
export function commandsOf(list, { read = () => {}, needs = null } = {}) {
  if (isAvailable(needs)) sources.push({ list, read });
}

/** Reads what the commands are about that depend on what is shown. */
export function readPresent() {
  for (const { read } of sources) read();
}

/** Returns the commands that are always there, in the order in which they were registered. */
export function permanent() {
  return known;
}

/** Returns the commands that depend on what is shown, and on the words of a search. */
export function present(search = "") {
  return sources.flatMap(({ list }) => list(search).map((one) => ({ key: null, ready: () => true, why: () => "", ...one })));
}

/** Returns the command of a key. */
export function commandOf(key) {
  return known.find((one) => one.key === key);
}

/** Runs a command if it is ready. */
export function run(one) {
  if (one.ready()) one.work();
}
