// Requests events of a long run while it is paused: a page that was opened late, or that opens a long recording, is sent only the latest ones, and
// it has not room for all. After a run has gone far back, it gets those around that moment.

import { effect, signal } from "./vendor/preact.js";
import { request } from "./server.js";
import { addEarlier, alive, events, replaceEvents, roomForEarlier, running, session, state, history } from "./store.js";

const AT_ONCE = 5000; // the number of events per request: more would delay commands
const AROUND = 45_000; // the number of events on each side of a moment of which the page has none

/** Whether they are being requested. */
export const fetching = signal(false);

/** Returns the numbers of the events that the page lacks and has room for: {from, to}, and `instead`, whether they are shown in place of those
 * that it has; null if it lacks none, or while the run goes on. */
function lacking() {
  const { list, first, elsewhere } = events.value;
  if (!alive.value || running.value || state.value === null) return null;
  const now = state.value.events;
  const repeats = session.value?.recorded !== null && session.value?.recording === null; // the server has the events after this moment, too
  const from = Math.max(0, first - roomForEarlier());
  if (now < first ? !repeats || now < from : elsewhere && now > first + list.length) {
    return { from: Math.max(0, now - AROUND), to: now + (repeats ? AROUND : 0), instead: true };
  }
  return from < first ? { from, to: first, instead: false } : null;
}

/** Returns what the page has now, to be compared with what it has when an answer comes. */
const held = () => ({ history: history.peek(), list: events.peek().list, first: events.peek().first });
const holds = (before) => Object.entries(held()).every(([name, value]) => value === before[name]);

/** Requests events; returns fewer than asked for if the run has no more. */
const between = async (begin, end) => (await request({ type: "events", first: begin, most: end - begin, ahead: true })).events;

/** Shows events in place of those that the page has, once all have come. */
async function fetchInstead({ from, to }) {
  const before = held();
  const found = [];
  for (let begin = from; begin < to; begin += AT_ONCE) {
    const some = await between(begin, Math.min(to, begin + AT_ONCE));
    if (!holds(before) || running.peek()) return;
    found.push(...some);
    if (some.length < AT_ONCE) break;
  }
  replaceEvents(from, found);
}

/** Adds events before those that the page has, the latest first, and shows them at once, as the lanes and the trace are made again then; if the run
 * goes on before the end, what has come by then. */
async function fetchBefore({ from, to }) {
  const before = held();
  const found = [];
  try {
    for (let end = to; end > from && !running.peek(); end -= AT_ONCE) {
      const begin = Math.max(from, end - AT_ONCE);
      const some = await between(begin, end);
      if (!holds(before) || some.length < end - begin) return;
      found.unshift(some);
    }
  } finally {
    if (found.length > 0 && holds(before)) addEarlier(found.flat());
  }
}

let asked = ""; // what was requested last: what did not come is not requested again and again

effect(() => {
  const wanted = lacking();
  if (wanted === null || fetching.value) return;
  const all = JSON.stringify([history.value, wanted, events.value.first]);
  if (all === asked) return;
  asked = all;
  fetching.value = true;
  (wanted.instead ? fetchInstead : fetchBefore)(wanted)
    .catch(() => {}) // another run is shown by now, or it has ended: the page says how many events it does not show
    .finally(() => (fetching.value = false));
});
