// The lanes of the run that is shown, updated with its events as they arrive.

import "../earlier_events.js";
import { effect, signal } from "../vendor/preact.js";
import { events } from "../store.js";
import { Lanes } from "./lanes.js";

export const lanes = new Lanes();
/** Counts the changes of the lanes. */
export const lanesVersion = signal(0);

const taken = { list: null, first: 0, next: 0 };

effect(() => {
  const { list, first, cut } = events.value;
  // If the end of a run is cut off, all lanes are rebuilt: it happens only when a user changes the run's past.
  if (list !== taken.list || cut) {
    lanes.clear();
    Object.assign(taken, { list, first, next: first });
  }
  for (let n = Math.max(0, taken.next - first); n < list.length; n += 1) lanes.take(list[n]);
  taken.next = first + list.length;
  if (first > taken.first) {
    taken.first = first;
    if (list.length) lanes.forget(list[0][0] / 1e6);
  }
  lanesVersion.value = lanesVersion.peek() + 1;
});
