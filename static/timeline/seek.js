// Goes to another time of the run: one seek at a time, and the newest target wins.

import { computed, signal } from "../vendor/preact.js";
import { exactTime, timeText } from "../parts/units.js";
import { request, sendCommand } from "../server.js";
import { alive, period, shownRun, state } from "../store.js";

/** The time to which the user is going [s]; null when the run is there. */
export const wanted = signal(null);
/** The time of the playhead [s]: the pointer's position at once, although the run may still be on its way. */
export const present = computed(() => wanted.value ?? state.value?.time ?? 0);
/** The time at which the playhead will be once the run is there [s]: where it is going, or is. */
const destination = computed(() => wanted.value ?? state.value?.target ?? present.value);
/** The furthest time that the run has reached [s]. */
export const furthest = computed(() => Math.max(state.value?.furthest ?? 0, state.value?.time ?? 0));
/** Returns a time of the run [s] as text; all its times look alike. `digits` as in `timeText`. */
export const runTimeText = (time, digits = 2) => timeText(time, digits, Math.max(time, furthest.value));
/** Whether the run has not reached a time [s] yet; times that people read are rounded to hundredths. */
export const isBeyond = (time) => time > furthest.peek() + 0.005;
/** Whether a known future lies ahead of the current moment. */
export const inThePast = computed(() => state.value !== null && state.value.time < furthest.value - 1e-7);

let going = false;
let said = null; // the latest time sent to the run [s]

/** Goes to a time [s]: the nearest tick that the run has reached. */
export function seek(time) {
  // Ticks are whole microseconds; the end of a program need not be at one.
  travel(exactTime(Math.round(time / period.peek()) * period.peek()), time);
}

/** Goes on or back by a number of ticks, from where the run is going. */
export function goTicks(ticks) {
  seek(Math.max(0, destination.peek() + ticks * period.peek()));
}

/** Goes to a time that the run has reached [s]. `requested` is the time before it was rounded to a tick: if it is not before the newest
 * time, this goes to the newest time. */
export function travel(time, requested = time) {
  if (!alive.peek()) return;
  wanted.value = requested >= furthest.peek() ? furthest.peek() : Math.min(Math.max(0, time), furthest.peek());
  if (!going) go();
}

async function go() {
  going = true;
  const whose = shownRun.peek();
  said = null;
  while (wanted.peek() !== null && wanted.peek() !== said && whose === shownRun.peek()) {
    said = wanted.peek();
    await sendCommand({ type: "seek", time: said }); // afterwards, the state shows the run there too
  }
  going = false;
  wanted.value = null;
}

/** Sends a command for the time to which the user has gone, although the run may still be on its way. */
export function sendCommandThere(what) {
  goThere();
  return sendCommand(what);
}

/** Does the same, but returns the result, as `request` does. */
export function requestThere(what) {
  goThere();
  return request(what);
}

function goThere() {
  if (wanted.peek() !== null && wanted.peek() !== said) sendCommand({ type: "seek", time: wanted.peek() });
  wanted.value = null;
}
