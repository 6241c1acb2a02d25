// The model's output, line by line with the numbers of its events: kept completely, although the list of events drops the oldest.

import { signal } from "../vendor/preact.js";
import { request } from "../server.js";
import { alive, eventCount, listeners, shownRun } from "../store.js";
import { firstWhere } from "../parts/search.js";

const MAX_LINES = 500_000; // the maximum number of lines; beyond it, the oldest are dropped
const AT_ONCE = 20_000; // the number of events requested at once
const NOTHING = { events: 0, notice: -1 };

/** Counts the changes of the lines. */
export const printedVersion = signal(0);

/** The lines in order, each {number, text}; `gaps` are the events that were never received, each [from, to]. */
let lines = [];
let gaps = [];
let next = 0; // the number of the next event
let dropped = 0; // the number of lines dropped because there were too many
let of = ""; // the session and run of the lines
let cleared = NOTHING; // what the user has cleared

function reset(run) {
  lines = [];
  gaps = [];
  next = 0;
  dropped = 0;
  cleared = NOTHING;
  of = run;
  printedVersion.value += 1;
}

/** Returns the index of the first line whose event has at least a given number. */
function placeOf(number) {
  return firstWhere(lines, (line) => line.number >= number);
}

function hear({ of: session, run, events: news }) {
  if (of !== `${session} ${run}`) reset(`${session} ${run}`);
  if (!news) return;
  const { cut, first, list } = news;
  const before = lines.length;
  if (cut !== undefined && cut < next) {
    lines.length = placeOf(cut);
    gaps = gaps.map(([from, to]) => [from, Math.min(to, cut)]).filter(([from, to]) => from < to);
    next = cut;
    cleared = { ...cleared, events: Math.min(cleared.events, cut) };
  }
  if (list.length === 0) {
    if (lines.length !== before) printedVersion.value += 1;
    return;
  }
  if (first > next) gaps.push([next, first]);
  list.forEach(([, , kind, data], n) => {
    if (kind === "output" && first + n >= next) lines.push({ number: first + n, text: String(data?.text ?? data?.["…"] ?? "") });
  });
  next = Math.max(next, first + list.length);
  if (lines.length > MAX_LINES) {
    dropped += lines.length - 0.9 * MAX_LINES;
    lines.splice(0, lines.length - 0.9 * MAX_LINES);
  }
  printedVersion.value += 1;
}

listeners.add(hear);

/** Returns what is known of the run that is shown: {lines, gaps, dropped, cleared, of}. */
export function printed() {
  printedVersion.value;
  return of === shownRun.peek() ? { lines, gaps, dropped, cleared, of } : { lines: [], gaps: [], dropped: 0, cleared: NOTHING, of: "" };
}

/** Clears the run that is shown: the lines of the first `events` events and the notices up to number `notice` are kept, but shown no
 * longer; by default, all are shown again. */
export function clear(events = 0, notice = -1) {
  cleared = { events, notice };
  printedVersion.value += 1;
}

let asking = false;

/** Requests the output in events that the page never received, up to the current moment. */
export async function fillGaps() {
  if (asking || !alive.peek() || of !== shownRun.peek()) return;
  const [from, to] = gaps[0] ?? [];
  const until = Math.min(to ?? 0, eventCount.peek());
  if (gaps.length === 0 || until <= from) return;
  asking = true;
  const mine = of;
  try {
    const answer = await request({ type: "events", first: from, most: Math.min(AT_ONCE, until - from), kinds: ["output"] });
    const gap = gaps[0];
    if (mine !== of || gap?.[0] !== from) return;
    const found = answer.events.map(([, , , data], n) => ({ number: answer.numbers[n], text: String(data?.text ?? "") }));
    lines.splice(placeOf(from), 0, ...found.filter(({ number }) => number < gap[1]));
    gap[0] = Math.min(answer.next, gap[1]);
    if (gap[0] >= gap[1]) gaps.shift();
    if (answer.next <= from) gaps.shift(); // the run does not have them either
    printedVersion.value += 1;
  } catch {
    // Another run is shown by now, or it has ended: the gap is shown.
  } finally {
    asking = false;
  }
}
