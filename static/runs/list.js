// The server's recordings, read in parts: the newest first, and again when a run ends.

import { batch, computed, effect, signal, untracked } from "../vendor/preact.js";
import { call } from "../server.js";
import { session, state, history } from "../store.js";

const PART = 250;
const LATER = 700; // [ms]
const MAX_TRIES = 5;

/** The summaries of recordings (`Summary` of the server), the newest first; null before the first arrive. */
export const runs = signal(null);
/** The number of recordings on the server. */
export const total = signal(0);
/** Why they cannot be listed; null if they can. */
export const problem = signal(null);
/** What is wrong with the names and notes of recordings; null if nothing is. */
export const warning = signal(null);
export const loading = signal(false);
/** Whether all recordings of the server are in `runs`. */
const isComplete = computed(() => runs.value !== null && runs.value.length >= total.value);

let asked = 0;
let tries = 0;

/** Returns summaries in which `origin`, `ancestors` and `copied` have present names: branches know a recording by its first name (`named`). */
export function withPresentNames(list) {
  const present = new Map([...list.map(({ id, named }) => [named, id]), ...list.filter(({ id, named }) => id === named).map(({ id }) => [id, id])]);
  const ids = new Set(list.map(({ id }) => id));
  const nameOf = (name) => present.get(name) ?? (ids.has(name) ? `${name} (deleted)` : name); // a later one may have the name of one that was deleted
  const named = ([name, at]) => [nameOf(name), at];
  return list.map((run) => ({ ...run, origin: nameOf(run.origin), ancestors: run.ancestors.map(named), copied: run.copied && named(run.copied) }));
}

/** Returns whether a recording is a branch of one that was deleted. */
export function isOrphan(run) {
  return run.origin !== null && isComplete.value && !runs.value.some(({ id }) => id === run.origin);
}

/** Yields the list of the server in parts: {recordings, total, warning}. */
export async function* parts() {
  let found = 0;
  let page;
  do {
    page = await call("GET", `/api/recordings?first=${found}&most=${PART}`);
    found += page.recordings.length;
    yield page;
  } while (page.recordings.length === PART && found < page.total);
}

/** Reads the list again, in parts; known entries stay on screen until they are replaced. */
export async function listRuns() {
  asked += 1;
  const mine = asked;
  loading.value = true;
  const found = new Map();
  try {
    for await (const page of parts()) {
      if (mine !== asked) return;
      for (const run of page.recordings) found.set(run.id, run);
      batch(() => {
        total.value = page.total;
        problem.value = null;
        warning.value = page.warning;
        if (runs.value === null || runs.value.length <= found.size) runs.value = withPresentNames([...found.values()]);
      });
    }
    runs.value = withPresentNames([...found.values()]);
  } catch (error) {
    if (mine === asked) problem.value = error.message;
  }
  if (mine !== asked) return;
  loading.value = false;
  awaitEnd(mine);
}

/** Reads the list again soon if the file of the current run is missing, or its end is not up to date: it is written a moment later. */
function awaitEnd(mine) {
  const { recording = null } = session.value ?? {};
  const own = runs.value?.find(({ id }) => id === recording);
  const { status, furthest } = state.value ?? {};
  const goesOn = own?.ended && own.time > furthest + 1e-6; // it had ended, but was changed in its past
  const late = own ? goesOn || (status === "ended" && !own.ended) : recording !== null && session.value.alive;
  tries = late ? tries + 1 : 0;
  if (tries > 0 && tries <= MAX_TRIES) setTimeout(() => mine === asked && listRuns(), LATER);
}

/** Removes a deleted recording from the list. */
export function forgetRun(id) {
  runs.value = runs.value.filter((run) => run.id !== id);
  total.value -= 1;
}

/** Keeps the list up to date while it is shown: the server reports whenever a recording of any session began, ended or was changed; what
 * others have changed in the folder is seen when the user returns to the page. Returns the function that stops this. */
export function followRuns() {
  const key = computed(() => `${session.value?.id} ${session.value?.recording_changes} ${history.value}`);
  const end = effect(() => {
    key.value;
    untracked(() => void listRuns());
  });
  addEventListener("focus", listRuns);
  return () => {
    removeEventListener("focus", listRuns);
    end();
  };
}
