// What the page knows, as signals, fed by the websocket. A panel that reads one is drawn again when it has changed.

import { remembered } from "./remembered.js";
import { batch, computed, signal } from "./vendor/preact.js";

const MOST_EVENTS = 200_000;
const MOST_NOTICES = 500;

/** What is known of the session and its run (`Telling.facts_json`); null before there is one. */
export const session = signal(null);
/** What this browser is called among those that watch; an empty text where that is not known yet. */
export const me = signal("");
/** The newest state: status, time, speed, apertures, parts (`Telling.state_json`); null before the first. */
export const state = signal(null);
/** The events of the run in order, each [time in us, source, kind, data]; also those after the present moment of a run that went
 * back. `first` is the number of the first, `missing` how many were left out before it. The list grows in place. */
export const events = signal({ list: [], first: 0, missing: 0 });
/** What the user is told: {number, level, text, file, line, detail, attempt, version}. */
export const notices = signal([]);
/** What is said while a model is on its way: {text, slow}; null otherwise. */
export const opening = signal(null);
/** Whether the websocket is open; null before it was for the first time. */
export const connected = signal(null);

export const running = computed(() => state.value?.status === "running");
/** Whether the run goes as fast as it can: then drawing it is not to take too much of the processor. */
export const hurried = computed(() => running.value && state.value.wanted === null);
/** Of which run the newest state is: what is shown of a new one is that of the run before until its own first state is there. */
const stated = signal(0);
/** Whether there is a run that can be asked. */
export const alive = computed(() => Boolean(session.value?.alive) && state.value !== null && stated.value === session.value.run);
/** The moment that is shown, as a text that differs between moments. */
export const moment = computed(() => `${session.value?.id} ${stated.value} ${state.value?.tick} ${state.value?.events}`);

/** Which events of which run are known, for a connection that is made again. */
export const known = { run: 0, epoch: 0 };
/** Tells the way that the run goes from others, as a text: those of other runs, and of the same before something was changed in its past. */
export const way = signal("");

/** Are told of each update before it is taken in: {of, run, events?}, for whoever keeps more of the events than the list has. */
export const listeners = new Set();

/** Takes in messages of the server. */
export function take(messages) {
  batch(() => messages.forEach(takeOne));
}

function takeOne(message) {
  for (const listener of listeners) listener(message);
  if (message.session) {
    session.value = message.session;
    opening.value = null;
  }
  if (message.you) me.value = message.you;
  if (message.run !== known.run) events.value = { list: [], first: 0, missing: 0, cut: false };
  Object.assign(known, { run: message.run, epoch: message.epoch });
  way.value = `${session.value?.id} ${message.run} ${message.epoch}`;
  if ("state" in message) {
    state.value = message.state;
    stated.value = message.run;
  }
  if (message.events) events.value = withEvents(events.value, message.events);
  if (message.notices) {
    const numbers = new Set(notices.value.map((notice) => notice.number));
    tell(message.notices.filter((notice) => !numbers.has(notice.number)));
  }
}

function withEvents({ list, first, missing }, news) {
  if (news.cut !== undefined) list.length = Math.max(0, Math.min(list.length, news.cut - first));
  if (news.missing || list.length === 0) {
    list = [];
    first = news.first;
    missing = news.first;
  }
  for (const event of news.list) list.push(event);
  if (list.length > MOST_EVENTS) {
    // A tenth more than needed, so that this is seldom.
    const drop = list.length - 0.9 * MOST_EVENTS;
    list.splice(0, drop);
    first += drop;
  }
  return { list, first, missing, cut: news.cut !== undefined };
}

function tell(told) {
  notices.value = [...notices.value, ...told].slice(-MOST_NOTICES);
}

let ownNotices = 0;

/** Tells the user something that the page itself has found. */
export function complain(text, level = "error") {
  ownNotices -= 1;
  tell([{ number: ownNotices, level, text, file: null, line: null, detail: "" }]);
}

// -- what the user has dealt with

const MOST_SETTLED = 50; // of so many sessions it is remembered

/** Up to which message of each session the user has seen them ("seen"), was shown them over the page ("shown") or has cleared them
 * away ("cleared"): {session: {kind: number}}. It outlives the page, for what is settled is not to come back when it is loaded again. */
const settled = remembered("settled messages", {});
/** The page's own messages, which are gone with it: {kind: number}, down to which they are settled. */
const ownSettled = signal({});

function settledKey() {
  return `${session.value?.id} ${session.value?.born}`;
}

/** Tells whether a message is settled in a way. */
export function isSettled({ number }, kind) {
  return number < 0 ? number >= (ownSettled.value[kind] ?? 0) : number <= (settled.value[settledKey()]?.[kind] ?? -1);
}

/** Takes all messages that there are as settled in a way. */
export function settle(kind) {
  const numbers = notices.peek().map(({ number }) => number);
  const [least, most] = [Math.min(0, ...numbers), Math.max(-1, ...numbers)];
  if (least < (ownSettled.peek()[kind] ?? 0)) ownSettled.value = { ...ownSettled.peek(), [kind]: least };
  const known = settled.peek()[settledKey()] ?? {};
  if (session.peek() === null || most <= (known[kind] ?? -1)) return;
  const others = Object.entries(settled.peek()).filter(([key]) => key !== settledKey()).slice(-MOST_SETTLED);
  settled.value = { ...Object.fromEntries(others), [settledKey()]: { ...known, [kind]: most } };
}

/** Tells the run that is shown from others. */
export function whichRun() {
  return `${session.peek()?.id} ${session.peek()?.run}`;
}

/** Forgets what is known of a session, for another one is shown. */
export function forget() {
  batch(() => {
    session.value = null;
    state.value = null;
    events.value = { list: [], first: 0, missing: 0, cut: false };
    notices.value = [];
    stated.value = 0;
    Object.assign(known, { run: 0, epoch: 0 });
    way.value = "";
  });
}
