// Requests the earlier events of a long run while it is paused: a page that was opened late, or that opens a long recording, is sent only the
// latest ones.

import { effect, signal } from "./vendor/preact.js";
import { say } from "./server.js";
import { addEarlier, alive, events, roomForEarlier, running, session, state, way } from "./store.js";

const AT_ONCE = 5000; // the number of events per request: more would delay commands

/** Whether they are being requested. */
export const fetching = signal(false);

/** Whether events are missing that the run has now, or the recording that it repeats, and the page has room for. */
function isMissing() {
  const { first } = events.value;
  const repeats = session.value?.recorded !== null && session.value?.recording === null;
  return alive.value && !running.value && first > 0 && (repeats || (state.value?.events ?? 0) >= first) && roomForEarlier() > 0;
}

/** Requests all that there is room for, the latest first, and shows it at once, as the lanes and the trace are made again then; if the run goes
 * on before the end, what has come by then. */
async function fetchEarlier() {
  const mine = way.peek();
  const { first } = events.peek();
  const begin = Math.max(0, first - roomForEarlier());
  const found = [];
  try {
    for (let end = first; end > begin && !running.peek(); end -= AT_ONCE) {
      const from = Math.max(begin, end - AT_ONCE);
      const answer = await say({ type: "events", first: from, most: end - from, ahead: true });
      if (mine !== way.peek() || answer.events.length < end - from) return;
      found.unshift(answer.events);
    }
  } finally {
    if (found.length > 0 && mine === way.peek() && events.peek().first === first) addEarlier(found.flat());
  }
}

effect(() => {
  if (!isMissing() || fetching.peek()) return;
  fetching.value = true;
  fetchEarlier()
    .catch(() => {}) // another run is shown by now, or it has ended: the page says how many events it does not show
    .finally(() => (fetching.value = false));
});
