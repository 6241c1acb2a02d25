// The page's data, as signals, updated by the websocket. A panel that reads a signal is drawn again when it changes.

import { remembered } from "./local_storage.js";
import { batch, computed, signal } from "./vendor/preact.js";

const MAX_EVENTS = 200_000;
const MAX_NOTICES = 500;

/** The facts about the session and its run (`Session.facts_json`); null before there is one. */
export const session = signal(null);
/** Whether the run has a world in which there is something to see. */
export const hasScene = computed(() => Boolean(session.value?.world) && !session.value.world.empty);
/** The name of this browser among the viewers; empty if not known yet. */
export const me = signal("");
/** The newest state: status, time, speed, apertures, parameters, parts (`Session.state_json`); null before the first. */
export const state = signal(null);
/** The events of the run in order, each [time in us, source, kind, data], where the time is that of the run's clock also for a program
 * that makes several runs; also those after the current moment of a run that went back. `first` is the number of the first: the page does not
 * have those before it. The list grows in place. `cut` says that its end was removed, `elsewhere` that it may end before the newest event that
 * the server has sent: a page has not room for all events of a long run, and has those around the moment to which it went back. */
export const events = signal({ list: [], first: 0 });
/** The notices to the user: {number, level, text, file, line, detail, attempt, version}. */
export const notices = signal([]);
/** The message while a model is loading: {text, slow}; null otherwise. */
export const opening = signal(null);
/** Whether the websocket is open; null before the first connection. */
export const connected = signal(null);
/** Whether the workbench was started again, with another token: then it answers this page no more. */
export const restarted = signal(false);

export const running = computed(() => state.value?.status === "running");
/** Whether the run goes as fast as possible: then drawing must not take too much of the processor. */
export const hurried = computed(() => running.value && state.value.wanted === null);
/** The recording that has the shown run: the one that it writes, or else the one that it repeats as long as it does; null for none. */
export const shownRecording = computed(() => session.value?.recording ?? (session.value?.branched ? null : session.value?.recorded) ?? null);
/** Whether other pages show the run, too. */
export const isShared = computed(() => (session.value?.watching ?? []).some((name) => name !== me.value));
/** The run and epoch of the newest state: until a new run sends its first state, the page shows that of the previous run. */
const stated = signal({ run: 0, epoch: 0 });
/** The number of the run's events up to the moment that is shown. */
export const eventCount = computed(() => state.value?.events ?? 0);
/** The bodies of the run's world, by name. */
export const bodies = computed(() => session.value?.world?.bodies ?? {});
/** Whether there is a run that can answer questions. */
export const alive = computed(() => Boolean(session.value?.alive) && state.value !== null && stated.value.run === session.value.run);
/** The moment that is shown, as a text that is unique for each moment, also of a run whose past was changed. */
export const moment = computed(() => [session.value?.id, stated.value.run, stated.value.epoch, state.value?.tick, state.value?.events].join(" "));

/** The run and the number of the known events, for a new connection. */
export const known = { run: 0, epoch: 0 };
/** Identifies the history of the run, as a text: it differs between runs, and within a run after a change in its past. */
export const history = signal("");

/** Called with each update before it is applied: {of, run, events?}, for code that keeps more events than the list. */
export const listeners = new Set();

/** Applies messages of the server. */
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
  if (message.run !== known.run) events.value = { list: [], first: 0 };
  Object.assign(known, { run: message.run, epoch: message.epoch });
  history.value = `${session.value?.id} ${message.run} ${message.epoch}`;
  if ("state" in message) {
    state.value = message.state;
    stated.value = { run: message.run, epoch: message.epoch };
  }
  if (message.events) events.value = withEvents(events.value, message.events);
  if (message.notices) {
    const numbers = new Set(notices.value.map((notice) => notice.number));
    addNotices(message.notices.filter((notice) => !numbers.has(notice.number)));
  }
}

/** The length of a tick of the run, or of a program's, which may have none [s]. */
export const period = computed(() => session.value?.period || 0.01);

/** Returns for how many events before those of the list there is room: fewer than the maximum, as new ones may come. */
export function roomForEarlier() {
  return 0.9 * MAX_EVENTS - events.value.list.length;
}

/** Shows other events of the run, from the number `first` on, in place of those of the list. */
export function replaceEvents(first, list) {
  events.value = { list, first, elsewhere: true };
}

/** Adds the events directly before those of the list, the latest of them if there is not room for all. */
export function addEarlier(earlier) {
  const { list, first } = events.peek();
  const added = earlier.slice(Math.max(0, earlier.length - roomForEarlier())); // new ones have come since these were requested
  events.value = { ...events.peek(), list: [...added, ...list], first: first - added.length, cut: false };
}

function withEvents({ list, first, elsewhere = false }, news) {
  if (news.cut !== undefined) list.length = Math.max(0, Math.min(list.length, news.cut - first));
  if (news.list.length > 0 || news.missing > 0) {
    if (list.length === 0 || news.first !== first + list.length) {
      list = [];
      first = news.first;
    }
    elsewhere = false;
  }
  for (const event of news.list) list.push(event);
  if (list.length > MAX_EVENTS) {
    // A tenth more than needed, so that this happens rarely.
    const drop = list.length - 0.9 * MAX_EVENTS;
    list.splice(0, drop);
    first += drop;
  }
  return { list, first, cut: news.cut !== undefined, elsewhere };
}

function addNotices(added) {
  notices.value = [...notices.value, ...added].slice(-MAX_NOTICES);
}

/** Whether a notice is of the run that is shown. */
function isOfShown({ attempt }) {
  return attempt !== undefined && attempt === session.value?.shown_attempt;
}

/** Whether a notice is from a part of the shown run that no longer exists, because a user has changed something before it. */
function isCut(notice) {
  const cuts = session.value?.cuts ?? [];
  return isOfShown(notice) && cuts.some(([next, kept]) => notice.number < next && notice.events > kept);
}

/** Whether a notice is of a later moment of the run than the one that is shown. */
export function isAhead(notice) {
  return isOfShown(notice) && !isCut(notice) && state.value !== null && notice.events > state.value.events;
}

/** Whether the run that is shown has given a notice, up to the moment that is shown. */
export function isGiven(notice) {
  return isOfShown(notice) && !isCut(notice) && !isAhead(notice);
}

/** Whether a notice is from the page itself, or from the newest run, which may have failed before it could be shown. If that run is shown,
 * only its notices up to the shown moment count. */
export function isPresent(notice) {
  const { attempt } = notice;
  return attempt === undefined || (attempt === session.value?.attempt && (!isOfShown(notice) || isGiven(notice)));
}

let ownNotices = 0;

/** Shows the user a problem found by the page itself, or something else; optionally with an action {text, work}, which can be taken once, and
 * the line {file, line} that it is about. */
export function notify(text, level = "error", action = null, { file = null, line = null } = {}) {
  ownNotices -= 1;
  addNotices([{ number: ownNotices, level, text, file, line, detail: "", action }]);
}

/** Takes the action of a notice, and removes the notice: what it says may no longer be true. */
export function takeAction(notice) {
  notices.value = notices.value.filter((one) => one !== notice);
  notice.action.work();
}

// -- what the user has seen or cleared

const MAX_SETTLED = 50; // the number of sessions remembered

/** The number of the last message of each session that the user has seen ("seen"), was shown over the page ("shown") or has cleared
 * ("cleared"): {session: {kind: number}}. It is stored, so that these messages do not return when the page is loaded again. */
const settled = remembered("settled messages", {});
/** The same for the page's own messages, which are not stored and have descending numbers: {kind: number}. */
const ownSettled = signal({});

function settledKey() {
  return `${session.value?.id} ${session.value?.born}`;
}

/** Returns whether a message is settled in a way: "seen", "shown" or "cleared". */
export function isSettled({ number }, kind) {
  return number < 0 ? number >= (ownSettled.value[kind] ?? 0) : number <= (settled.value[settledKey()]?.[kind] ?? -1);
}

/** Marks messages, and all before them, as settled in a way. */
export function settle(kind, messages) {
  const numbers = messages.map(({ number }) => number);
  const [least, most] = [Math.min(0, ...numbers), Math.max(-1, ...numbers)];
  if (least < (ownSettled.peek()[kind] ?? 0)) ownSettled.value = { ...ownSettled.peek(), [kind]: least };
  const key = settledKey();
  if (session.peek() === null || most <= (settled.peek()[key]?.[kind] ?? -1)) return;
  const { [key]: known = {}, ...others } = settled.newest();
  settled.value = { ...Object.fromEntries(Object.entries(others).slice(-MAX_SETTLED)), [key]: { ...known, [kind]: Math.max(most, known[kind] ?? -1) } };
}

/** A key for the run that is shown. */
export const shownRun = computed(() => `${session.value?.id} ${session.value?.run}`);

/** Removes the data of a session, because another one is shown. */
export function forget() {
  batch(() => {
    session.value = null;
    state.value = null;
    events.value = { list: [], first: 0 };
    notices.value = [];
    stated.value = { run: 0, epoch: 0 };
    Object.assign(known, { run: 0, epoch: 0 });
    history.value = "";
  });
}
