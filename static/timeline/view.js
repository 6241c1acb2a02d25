// Which stretch of time the timeline shows: all of it, what happens now, or what the user has chosen.

import { signal } from "../vendor/preact.js";

const LADDER = [1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8, 10];
const LEAST = 0.02; // the shortest stretch that is shown [s]
const AHEAD = 0.1; // so much of the width is kept free after the newest moment

/** From when to when the timeline shows [s]. */
export const span = signal({ from: 0, to: 1 });
/** "fit": all of the run; "follow": the present stays in view; "free": as the user has left it. */
export const mode = signal("fit");

/** Returns how far an axis goes on which a whole run fits [s]: it grows in steps, so that what is on it does not move all the time;
 * of a run that stands at its start, a second. */
export function fitEnd(furthest, least = LEAST) {
  const wanted = furthest > 0 ? Math.max(least, furthest * 1.01) : 1;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * LADDER.find((step) => step * power >= wanted);
}

function show(from, to) {
  if (from !== span.peek().from || to !== span.peek().to) span.value = { from, to };
}

/** Brings the view to where the run is; while it goes on it does not wait until that is at the edge. */
export function settle(present, furthest, running) {
  const { from, to } = span.peek();
  if (mode.value === "fit") show(0, fitEnd(furthest, running ? 1 : LEAST)); // a run that begins would make it move at once
  else if (mode.value === "follow") {
    const width = to - from;
    if (present > to - (running ? AHEAD * width : 0)) show(present - (1 - AHEAD) * width, present + AHEAD * width);
    else if (present < from) show(Math.max(0, present - AHEAD * width), Math.max(0, present - AHEAD * width) + width);
  }
}

export function fit() {
  mode.value = "fit";
}

function choose(from, to, present, furthest) {
  const end = fitEnd(furthest);
  const width = Math.min(Math.max(to - from, LEAST), end);
  const begin = Math.min(Math.max(0, from), end - width);
  show(begin, begin + width);
  if (width >= end) mode.value = "fit";
  else mode.value = present >= begin && present <= begin + width ? "follow" : "free";
}

/** Shows a stretch `factor` times as long, in which a moment stays where it is. */
export function zoom(factor, about, present, furthest) {
  const { from, to } = span.peek();
  const width = Math.min(Math.max((to - from) * factor, LEAST), fitEnd(furthest));
  const share = (about - from) / (to - from);
  choose(about - share * width, about + (1 - share) * width, present, furthest);
}

/** Moves the view by some time [s]. */
export function pan(by, present, furthest) {
  const { from, to } = span.peek();
  const room = Math.max(0, fitEnd(furthest) - (to - from));
  const begin = Math.min(Math.max(0, from + by), room);
  choose(begin, begin + to - from, present, furthest);
}
