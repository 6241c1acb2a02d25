// What the text of the shown run says of the model: its docstring, its agents with their productions and parts.

import { signal, useLayoutEffect } from "../vendor/preact.js";
import { call } from "../server.js";
import { isBare, runStatus } from "../run_status.js";
import { session } from "../store.js";

const loaded = signal({ key: "", answer: null, problem: null });

/** Returns a key for the text and the run that a description belongs to. */
function keyOf({ id, run, attempt, shown_attempt: shown }) {
  return `${id} ${run} ${shown ?? attempt}`;
}

async function follow(wanted) {
  const key = keyOf(wanted);
  if (loaded.peek().key === key) return;
  const same = loaded.peek().key.split(" ")[0] === wanted.id; // the description of the former run stays until the new one is there
  loaded.value = { key, answer: same ? loaded.peek().answer : null, problem: null };
  let answer = null;
  let problem = null;
  try {
    answer = await call("GET", `/api/sessions/${encodeURIComponent(wanted.id)}/about`);
  } catch (error) {
    problem = error.message;
  }
  if (loaded.peek().key === key) loaded.value = { key, answer, problem };
}

/** Returns {answer, problem}: the description of the model that is shown, as `/api/sessions/ID/about` returns it, or why there is none.
 * Both are null until it is read. */
export function useDescription() {
  const shown = session.value;
  useLayoutEffect(() => void (shown && follow(shown)));
  return loaded.value;
}

/** Returns the agents that the text of a program has, before the program has run and made any: [{name, productions, parts}]. */
export function useWrittenAgents() {
  const { answer } = useDescription();
  return isBare.value && runStatus.value.is === "ready" ? answer?.agents ?? [] : [];
}
