// The recordings that the server has, read in parts: the newest first, and again when a run ends.

import { batch, computed, effect, signal, untracked } from "../vendor/preact.js";
import { call } from "../server.js";
import { isOver } from "../standing.js";
import { session, state } from "../store.js";

const PART = 250;
const LATER = 700; // [ms]
const MOST_TRIES = 5;

/** What is known of recordings (`Summary` of the server), the newest first; null before the first are there. */
export const runs = signal(null);
/** How many there are on the server. */
export const total = signal(0);
/** Why they cannot be listed; null where they can. */
export const problem = signal(null);
export const loading = signal(false);
/** The recording that the present run writes; null where it writes none. */
export const present = computed(() => session.value?.recording ?? null);

let asked = 0;
let tries = 0;

/** Reads the list anew, in parts; what is there already stays on screen until it is known better. */
export async function listRuns() {
  asked += 1;
  const mine = asked;
  loading.value = true;
  const found = new Map();
  try {
    do {
      const told = await call("GET", `/api/recordings?first=${found.size}&most=${PART}`);
      if (mine !== asked) return;
      for (const run of told.recordings) found.set(run.id, run);
      batch(() => {
        total.value = told.total;
        problem.value = null;
        if (runs.value === null || runs.value.length <= found.size) runs.value = [...found.values()];
      });
      if (told.recordings.length < PART) break;
    } while (found.size < total.value);
    runs.value = [...found.values()];
  } catch (error) {
    if (mine === asked) problem.value = error.message;
  }
  if (mine !== asked) return;
  loading.value = false;
  awaitEnd(mine);
}

/** Reads anew soon, where the file of the present run is not there yet, or does not say that it is over: it is written a moment later. */
function awaitEnd(mine) {
  const own = runs.value?.find(({ id }) => id === present.value);
  const late = own ? state.value?.status === "ended" && !own.ended : present.value !== null && session.value.alive;
  tries = late ? tries + 1 : 0;
  if (tries > 0 && tries <= MOST_TRIES) setTimeout(() => mine === asked && listRuns(), LATER);
}

/** Forgets a recording that is deleted. */
export function forgetRun(id) {
  runs.value = runs.value.filter((run) => run.id !== id);
  total.value -= 1;
}

/** Keeps the list as the server has it for as long as it is shown; returns what ends that. */
export function follow() {
  const key = computed(() => `${session.value?.id} ${session.value?.run} ${session.value?.alive} ${isOver.value}`);
  return effect(() => {
    key.value;
    untracked(() => void listRuns());
  });
}
