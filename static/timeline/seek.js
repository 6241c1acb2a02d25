// Going to another time of the run: one journey at a time, and the newest wish wins.

import { computed, signal } from "../vendor/preact.js";
import { order, say } from "../server.js";
import { alive, session, state, whichRun } from "../store.js";

/** Where the user is going to [s]; null when the run is there. */
export const wanted = signal(null);
/** The moment that the playhead stands at [s]: where the pointer is at once, though the run may still be on its way. */
export const present = computed(() => wanted.value ?? state.value?.time ?? 0);
/** How far the run has come [s]. */
export const furthest = computed(() => Math.max(state.value?.furthest ?? 0, state.value?.time ?? 0));
/** Whether there is a future to go on into that is known. */
export const inThePast = computed(() => state.value !== null && state.value.time < furthest.value - 1e-7);

let going = false;
let said = null; // the time that the run was last told to go to [s]

/** Goes to a time [s]: the nearest tick that the run has been at. */
export function seek(time) {
  const period = session.peek()?.period || 0.01;
  // Ticks are whole microseconds; the end of a program need not be one.
  travel(Math.round((Math.round(time / period) * period) * 1e6) / 1e6, time);
}

/** Goes to a time at which the run has stood [s]; to the newest where `wish`, which the time is made of, is as late. */
export function travel(time, wish = time) {
  if (!alive.peek()) return;
  wanted.value = wish >= furthest.peek() ? furthest.peek() : Math.min(Math.max(0, time), furthest.peek());
  if (!going) go();
}

async function go() {
  going = true;
  const whose = whichRun();
  said = null;
  while (wanted.peek() !== null && wanted.peek() !== said && whose === whichRun()) {
    said = wanted.peek();
    await order({ type: "seek", time: said }); // then the run is seen to be there, too
  }
  going = false;
  wanted.value = null;
}

/** Does a command where the user has gone to, though the run may still be on its way there. */
export function orderThere(what) {
  goThere();
  return order(what);
}

/** The same, but who calls it is told what comes of it, as by `say`. */
export function sayThere(what) {
  goThere();
  return say(what);
}

function goThere() {
  if (wanted.peek() !== null && wanted.peek() !== said) order({ type: "seek", time: wanted.peek() });
  wanted.value = null;
}
