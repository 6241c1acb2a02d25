// Asks the server about a text: completions, documentation, definitions, names, format. Answers come from a process that only reads it.

import { call } from "../server.js";

/** The maximum length of a text that the server reads. */
const LONGEST_READ = 200_000;

/** Returns the path of the text in a view; code.js fills it in. */
export const shownText = { path: () => null };

let asking = Promise.resolve();
const newest = new Map();

/** Asks about a state of the text that is shown: `complete`, `document item`, `document`, `signature`, `define`, `rename` or `format`;
 * `name` is a label of a completion, or a new name. One question at a time: of several that wait, only the newest of each kind is asked;
 * the others get null. Rejects if the server has no answer: with an Error, whose `line` is that of the text that is the reason, if
 * there is one. */
export function askAbout(state, ask, at = 0, name = "") {
  const path = shownText.path();
  if (path === null) return Promise.resolve(null);
  if (state.doc.length > LONGEST_READ) return Promise.reject(new Error(`The text is longer than ${LONGEST_READ.toLocaleString("en")} characters: it is not read for help.`));
  const turn = {};
  newest.set(ask, turn);
  const answer = asking.then(() => (newest.get(ask) === turn ? answerTo({ ask, path, text: state.doc.toString(), at, name }) : null));
  asking = answer.catch(() => {});
  return answer;
}

async function answerTo(question) {
  const answer = await call("POST", "/api/language", question);
  if (answer?.unanswered) throw Object.assign(new Error(answer.unanswered), { line: answer.line });
  return answer;
}

/** The same, for help that nobody asked for: without an answer it returns null. */
export function helpWith(...question) {
  return askAbout(...question).catch(() => null);
}
