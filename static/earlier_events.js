// Requests the earlier events of a long run while it is paused: a page that was opened late is sent only the latest ones.

import { effect } from "./vendor/preact.js";
import { say } from "./server.js";
import { addEarlier, alive, events, roomForEarlier, running, state, way } from "./store.js";

const AT_ONCE = 5000; // the number of events per request: more would delay commands

let asking = false;

/** Whether events are missing that the run has now, and the page has room for. */
function isMissing() {
  const { first } = events.value;
  return alive.value && !running.value && first > 0 && (state.value?.events ?? 0) >= first && roomForEarlier() > 0;
}

/** Requests all that there is room for, and shows it at once, as the lanes and the trace are made again then. */
async function fetchEarlier() {
  const mine = way.peek();
  const { first } = events.peek();
  const begin = Math.max(0, first - roomForEarlier());
  const found = [];
  while (begin + found.length < first) {
    const number = begin + found.length;
    const answer = await say({ type: "events", first: number, most: Math.min(AT_ONCE, first - number) });
    if (mine !== way.peek() || running.peek() || answer.events.length === 0) return;
    for (const event of answer.events) found.push(event);
  }
  if (events.peek().first === first) addEarlier(found);
}

effect(() => {
  if (!isMissing() || asking) return;
  asking = true;
  fetchEarlier()
    .catch(() => {}) // another run is shown by now, or it has ended: the page says how many events it does not show
    .finally(() => (asking = false));
});
