// What the page knows, fed by the websocket. Panels look at it and are told when a part of it has changed.

const MOST_EVENTS = 100000;

export const store = {
  session: null, // what is known of the session and its run: see Session.facts_json
  state: null, // the newest state: status, time, speed, apertures, parts
  events: [], // [time in us, source, kind, data]
  firstEvent: 0, // the number of the first of them
  missing: 0, // how many events were left out before them
  notices: [],
  connected: false,
  run: 0,
  epoch: 0,
};

const listeners = new Map();
const waiting = new Set();
let asked = false;

/** Calls `listener` after one of the named parts ("session", "state", "events", "notices", "connected") has changed. */
export function watch(names, listener) {
  for (const name of names) {
    if (!listeners.has(name)) listeners.set(name, new Set());
    listeners.get(name).add(listener);
  }
}

export function changed(...names) {
  names.forEach((name) => waiting.add(name));
  if (asked) return;
  asked = true;
  // Not with the next picture: the 3D view may take long for one, and a page in the background draws none.
  setTimeout(() => {
    asked = false;
    const due = new Set([...waiting].flatMap((name) => [...(listeners.get(name) ?? [])]));
    waiting.clear();
    due.forEach((listener) => listener());
  });
}

/** Takes in one message of the server. */
export function take(message) {
  const parts = [];
  if (message.session) {
    store.session = message.session;
    parts.push("session");
  }
  if (message.run !== store.run) {
    Object.assign(store, { events: [], firstEvent: 0, missing: 0 });
    parts.push("events");
  }
  store.run = message.run;
  store.epoch = message.epoch;
  if ("state" in message) {
    store.state = message.state;
    parts.push("state");
  }
  if (message.events) {
    takeEvents(message.events);
    parts.push("events");
  }
  if (message.notices) {
    const known = new Set(store.notices.map((notice) => notice.number));
    store.notices.push(...message.notices.filter((notice) => !known.has(notice.number)));
    store.notices = store.notices.slice(-500);
    parts.push("notices");
  }
  changed(...parts);
}

function takeEvents({ first, list, cut, missing }) {
  if (cut !== undefined) store.events.length = Math.max(0, Math.min(store.events.length, cut - store.firstEvent));
  if (missing || store.events.length === 0) {
    store.events = [];
    store.firstEvent = first;
    store.missing = first;
  }
  store.events.push(...list);
  if (store.events.length > MOST_EVENTS) {
    const drop = store.events.length - MOST_EVENTS;
    store.events.splice(0, drop);
    store.firstEvent += drop;
  }
}

/** Forgets what is known of a session, for another one is shown. */
export function forget() {
  Object.assign(store, { session: null, state: null, events: [], firstEvent: 0, missing: 0, notices: [], run: 0, epoch: 0 });
  changed("session", "state", "events", "notices");
}
