// The stretch of time that the timeline shows: the whole run with its branches, the present, or the user's choice. `furthest` is the newest
// time of any of them [s].

import { session } from "../store.js";
import { effect, signal } from "../vendor/preact.js";

const LADDER = [1, 1.25, 1.6, 2, 2.5, 3.2, 4, 5, 6.3, 8, 10];
const MIN_SPAN = 0.02; // the shortest visible stretch [s]
const AHEAD = 0.1; // the part of the width that stays free after the newest moment

/** The first and last visible time [s]. */
export const span = signal({ from: 0, to: 1 });
/** "fit": the whole run, or what happened in it; "follow": the present stays in view; "free": the user's choice. */
export const mode = signal("fit");

/** Returns the length of an axis for a whole run [s]: it grows in steps, so that its contents do not move all the time;
 * one second for a run at its start. */
function fitEnd(furthest, least = MIN_SPAN) {
  const wanted = furthest > 0 ? Math.max(least, furthest * 1.01) : 1;
  const power = 10 ** Math.floor(Math.log10(wanted));
  return power * LADDER.find((step) => step * power >= wanted);
}

function show(from, to) {
  if (from !== span.peek().from || to !== span.peek().to) span.value = { from, to };
}

/** Moves the view to the run's time; while the run is active, before the present reaches the edge. */
export function settle(present, furthest, running) {
  const { from, to } = span.peek();
  if (quietEnd?.at !== furthest) quietEnd = null;
  if (mode.value === "fit") show(0, fitEnd(quietEnd?.from ?? furthest, running ? 1 : MIN_SPAN)); // otherwise a starting run would move it at once
  else if (mode.value === "follow") {
    const width = to - from;
    if (present > to - (running ? AHEAD * width : 0)) show(present - (1 - AHEAD) * width, present + AHEAD * width);
    else if (present < from) show(Math.max(0, present - AHEAD * width), Math.max(0, present - AHEAD * width) + width);
  }
}

/** The end of the run in which nothing happens, if it is left out: {from, at} [s]; null if all is shown. */
let quietEnd = null;

/** Shows all of the run. */
function fit() {
  quietEnd = null;
  mode.value = "fit";
}

/** Shows what happened, up to a time [s]; if that is shown already, all of the run up to its newest time. */
export function fitTo(happened, furthest) {
  const isShown = mode.peek() === "fit" && quietEnd !== null;
  fit();
  if (happened < furthest && !isShown) quietEnd = { from: happened, at: furthest };
  show(0, fitEnd(quietEnd?.from ?? furthest));
}

// Another model is shown as a whole at first.
effect(() => {
  if (session.value === null) fit();
});

function choose(from, to, present, furthest) {
  const end = fitEnd(furthest);
  const width = Math.min(Math.max(to - from, MIN_SPAN), end);
  const begin = Math.min(Math.max(0, from), end - width);
  show(begin, begin + width);
  if (width >= end) mode.value = "fit";
  else mode.value = present >= begin && present <= begin + width ? "follow" : "free";
}

/** Shows a stretch `factor` times as long, in which a given moment keeps its position. */
export function zoom(factor, about, present, furthest) {
  const { from, to } = span.peek();
  const width = Math.min(Math.max((to - from) * factor, MIN_SPAN), fitEnd(furthest));
  const share = (about - from) / (to - from);
  choose(about - share * width, about + (1 - share) * width, present, furthest);
}

/** Moves the view by a time [s]. */
export function pan(by, present, furthest) {
  const { from, to } = span.peek();
  const room = Math.max(0, fitEnd(furthest) - (to - from));
  const begin = Math.min(Math.max(0, from + by), room);
  choose(begin, begin + to - from, present, furthest);
}
