// Going to another time of the run: one journey at a time, and the newest wish wins.

import { computed, effect, signal } from "../vendor/preact.js";
import { say } from "../server.js";
import { alive, complain, session, state } from "../store.js";

/** Where the user is going to [s]; null when the run is there. */
export const wanted = signal(null);
/** The moment that the playhead stands at [s]: where the pointer is at once, though the run may still be on its way. */
export const present = computed(() => wanted.value ?? state.value?.time ?? 0);
/** How far the run has come [s]. */
export const furthest = computed(() => Math.max(state.value?.furthest ?? 0, state.value?.time ?? 0));
/** Whether there is a future to go on into that is known. */
export const inThePast = computed(() => state.value !== null && state.value.time < furthest.value - 1e-7);

const PATIENCE = 1000; // so long the playhead waits for the run [ms]
let going = false;

/** Waits until the run is seen to be at a time. */
function arrived(time) {
  return new Promise((resolve) => {
    let timer = 0;
    let end = () => {};
    const done = () => {
      clearTimeout(timer);
      queueMicrotask(() => end());
      resolve();
    };
    timer = setTimeout(done, PATIENCE);
    end = effect(() => {
      if (Math.abs((state.value?.time ?? time) - time) < 1e-6) done();
    });
  });
}

/** Goes to a time [s]: the nearest tick that the run has been at. */
export function seek(time) {
  if (!alive.peek()) return;
  const period = session.peek()?.period || 0.01;
  // Ticks are whole microseconds; the end of a program need not be one.
  const tick = Math.round((Math.round(time / period) * period) * 1e6) / 1e6;
  wanted.value = time >= furthest.peek() ? furthest.peek() : Math.min(Math.max(0, tick), furthest.peek());
  if (!going) go();
}

async function go() {
  going = true;
  const running = () => state.peek()?.status === "running";
  let at = running() ? null : state.peek()?.time;
  while (wanted.peek() !== null && wanted.peek() !== at) {
    at = wanted.peek();
    try {
      await say({ type: "seek", time: at });
      await arrived(at);
    } catch (error) {
      complain(error.message);
      break;
    }
  }
  going = false;
  wanted.value = null;
}
