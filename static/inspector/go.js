// Goes to the moment of an event.

import { complain, events, session } from "../store.js";
import { travel } from "../timeline/seek.js";

const runOf = (source) => (source.startsWith("top#") ? source.slice(4).split(".")[0] : "1");

/** Returns the time of an event in the whole session [us]: if a program makes one run after another, this adds the durations of
 * the earlier runs. Null if unknown, because the first events are no longer kept. */
function clockAt(number) {
  const { list, first } = events.peek();
  const [time, source] = list[number - first];
  if (session.peek()?.kind !== "program") return time;
  const latest = new Map();
  for (let n = 0; n <= number - first; n += 1) latest.set(runOf(list[n][1]), list[n][0]);
  if (first > 0 && (latest.size > 1 || runOf(source) !== "1")) return null;
  return [...latest.values()].reduce((sum, one) => sum + one, 0);
}

/** Takes the run to its first stop after an event. */
export function goTo(number) {
  const time = clockAt(number);
  if (time === null) {
    complain("This event's time in the whole session is not known, for the first events are no longer there.", "warning");
    return;
  }
  const { kind, period } = session.peek();
  const tick = kind === "program" ? 1 : Math.round(period * 1e6);
  travel((Math.ceil(time / tick) * tick) / 1e6);
}
