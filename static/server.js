// Communicates with the server: REST for files, sessions and recordings; one websocket for a session's state and commands.

import { page } from "./address.js";
import { frameBudget } from "./frame_budget.js";
import { askBy, awaited, heard } from "./silence.js";
import { connected, events, forget, hurried, known, notify, opening, restarted, session, take } from "./store.js";

const FIRST_START = "The workbench is starting: it loads what models need. On the first start after an installation, the camera's code is compiled, too, which takes up to a minute.";
/** The delay before a new attempt to reach the workbench [ms]. */
export const AGAIN = 1000;

let socket = null;
let shown = null;
let number = 0;
let choices = 0;
const waiting = new Map();
const updates = []; // what has arrived and waits to be drawn
let timer = 0;

/** Calls the REST interface; returns the response, or throws an Error with the reason, with `status` and `body`. An AbortSignal
 * cancels the call. */
export async function call(method, path, body, signal) {
  // Every change is sent as JSON with a custom header, which no form of another site can send.
  const headers = method === "GET" ? {} : { "content-type": "application/json", "x-workbench": "1" };
  return answered(await answerOf(path, { method, headers, body: body === undefined ? undefined : JSON.stringify(body), signal }));
}

/** Returns the address of a recording. */
export const recordingPath = (id) => `/api/recordings/${encodeURIComponent(id)}`;

/** Sends a recording file; returns the response, or throws an Error with the reason. */
export async function sendFile(path, file) {
  return answered(await answerOf(path, { method: "POST", headers: { "content-type": "application/vnd.sqlite3", "x-workbench": "1" }, body: file }));
}

async function answered(response) {
  const answer = parsed(await response.text());
  if (!response.ok) throw refusal(response, answer);
  return answer;
}

/** Fetches a whole file; returns it as a Blob, or throws an Error with the reason. `progress` is called with the number of bytes
 * received and the total. An AbortSignal cancels it. */
export async function fetchFile(path, signal, progress) {
  const response = await answerOf(path, { signal });
  if (!response.ok) throw refusal(response, parsed(await response.text()));
  const all = Number(response.headers.get("content-length"));
  let come = 0;
  const count = new TransformStream({
    transform(part, on) {
      come += part.length;
      progress(come, all);
      on.enqueue(part);
    },
  });
  const blob = await new Response(response.body.pipeThrough(count)).blob().catch(() => null);
  if (signal.aborted) throw new DOMException("cancelled", "AbortError");
  if (blob?.size !== all) throw new Error(`it broke off after ${come.toLocaleString("en")} of ${all.toLocaleString("en")} bytes`);
  return blob;
}

/** Returns the response. A request that changes nothing is repeated until the workbench answers this browser: it may have been started again. */
async function answerOf(path, options) {
  const isQuestion = options.method === "GET";
  for (;;) {
    const response = await oneAnswer(path, options).catch((error) => {
      if (!isQuestion || options.signal?.aborted) throw error;
    });
    if (response && !(isQuestion && response.status === 401)) return response;
    do await new Promise((resolve) => setTimeout(resolve, AGAIN));
    while (connected.peek() === false && !options.signal?.aborted);
  }
}

async function oneAnswer(path, options) {
  const answered = awaited();
  try {
    const response = await fetch(path, options);
    heard();
    return response;
  } catch {
    throw Object.assign(new Error("the workbench does not answer; is it still running?"), { status: 0, body: null });
  } finally {
    answered();
  }
}

function parsed(text) {
  try {
    return JSON.parse(text);
  } catch {
    return { error: text };
  }
}

/** Returns the Error for a response that gives the reason of a failure. */
function refusal(response, body) {
  const reason = typeof body.error === "string" ? body.error : JSON.stringify(body.detail ?? body);
  return Object.assign(new Error(reason), { status: response.status, body });
}

/** Called when the user chooses something that takes a while to show; returns a function that checks whether it is still wanted:
 * of two choices in quick succession, the first may be ready last. */
function newChoice() {
  choices += 1;
  return sinceNow();
}

/** Returns a function that checks whether the user has chosen nothing else since now. */
export function sinceNow() {
  const now = choices;
  return () => now === choices;
}

/** Shows a session from now on. One that is shown already stays attached: another `attach` would lose the pending replies. */
export function show(session) {
  if (session === shown) return;
  leave();
  opening.value ??= { text: "The run is being opened …", slow: false }; // until its first message
  shown = session;
  if (socket?.readyState === WebSocket.OPEN) attach();
  else connect();
}

askBy(() => {
  const isOpen = socket?.readyState === WebSocket.OPEN;
  if (isOpen) socket.send('{"type":"ping"}');
  return isOpen;
});

/** Whether an error only means that the page shows another run by now. */
export const isLeft = (error) => error.left === true;

/** Shows no session until another one is ready; messages of the previous one are ignored from now on. */
function leave() {
  shown = null;
  updates.length = 0;
  forget();
  abandon(() => Object.assign(new Error("another run is shown now"), { left: true }));
}

/** Cancels all pending requests. */
function abandon(reason) {
  for (const number of [...waiting.keys()]) settled(number).reject(reason());
}

/** Returns {resolve, reject} of a request that waits no longer; nothing if it is not known. */
function settled(number) {
  const { resolve, reject, answered } = waiting.get(number) ?? {};
  waiting.delete(number);
  answered?.();
  return { resolve, reject };
}

/** Returns the session that is shown with a model: the newest that is not of a recording; undefined for none. */
export function sessionOf(model, sessions) {
  return sessions.findLast((session) => session.model === model && session.recorded === null);
}

/** Shows a model: its open session, or a new one. With `run` it runs from its start, with the file's current text; a run that still waits at
 * its start is always one of the current text. Returns whether it is shown: the user may have chosen something else meanwhile. */
export async function showModel(model, { run = false } = {}) {
  const wanted = newChoice();
  if (model !== session.peek()?.model || session.peek().recorded !== null) leave();
  const { sessions, ready } = await call("GET", "/api/sessions");
  const there = sessionOf(model, sessions);
  if (!wanted() && !run) return false;
  if (wanted() && session.peek() === null) opening.value = ready ? { text: `${model} is being loaded …`, slow: false } : { text: FIRST_START, slow: true };
  try {
    if (there && (run || there.outdated)) await call("POST", `/api/sessions/${there.id}/command`, { command: { type: "restart", run } });
    const { id } = there ?? (await call("POST", "/api/sessions", { model, run, real_time: true }));
    if (wanted()) show(id);
    return wanted();
  } catch (error) {
    if (wanted()) opening.value = null;
    throw error;
  }
}

/** Shows a recording: the session that replays it, or a new one. With `trust` its code runs regardless of its origin; with `run` it goes on.
 * With `at` it is at that moment [s] when it is shown, unless another page shows it already. Returns whether it is shown: the user may have
 * chosen something else meanwhile. */
export async function showRecording(id, { trust = false, run = false, at = null } = {}) {
  const wanted = newChoice();
  if (session.peek() === null) opening.value = { text: `The recording ${id} is being opened …`, slow: false };
  try {
    const found = await call("POST", `${recordingPath(id)}/open`, { real_time: true, trust });
    if (at !== null && wanted() && found.watching.length === 0) {
      const seek = { command: { type: "seek", time: at } };
      await call("POST", `/api/sessions/${found.id}/command`, seek).catch(() => {}); // if it cannot be built, it is shown, and says why
    }
    if (!wanted()) return false;
    show(found.id);
    if (run) sendCommand({ type: "run" });
    return true;
  } catch (error) {
    if (!wanted()) return false;
    opening.value = null;
    throw error;
  }
}

function attach() {
  const { first, list } = events.value;
  const { born } = session.peek() ?? {}; // a workbench that was started again has other sessions with the same names
  socket.send(JSON.stringify({ type: "attach", session: shown, born, run: known.run, epoch: known.epoch, events: first + list.length, page }));
}

/** Opens the websocket, unless it is open; a connection that is lost is opened again. */
export function connect() {
  if (socket && socket.readyState <= WebSocket.OPEN) return;
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
  socket.onopen = () => {
    connected.value = true;
    if (shown) attach();
  };
  socket.onmessage = ({ data }) => {
    heard();
    const message = JSON.parse(data);
    if (message.type === "refused") refused(message);
    if (message.type !== "update" || message.of !== shown) return; // messages of the previously shown session may still arrive
    updates.push(message);
    // A pause of the run is shown at once.
    if (message.state && message.state.status !== "running") update();
    else updateSoon();
  };
  socket.onclose = ({ reason }) => {
    connected.value = false;
    heard();
    update(); // otherwise the next connection sends these updates again
    abandon(() => new Error(reason ? `the workbench ended the connection: ${reason}` : "the connection was lost"));
    if (session.peek()) seeWhetherRestarted();
    setTimeout(connect, AGAIN);
  };
}

async function seeWhetherRestarted() {
  const answer = await fetch("/api/sessions").catch(() => null);
  restarted.value = answer?.status === 401;
}

/** Deals with what the server does not do: a session that was ended while there was no connection is opened again. */
function refused({ error, id, session: asked }) {
  const { reject } = settled(id);
  if (reject) reject(new Error(error));
  else if (asked === undefined || asked !== shown || session.peek() === null) {
    if (asked === shown) opening.value = null;
    notify(error);
  }
  else {
    const { model, recorded } = session.peek();
    leave();
    const why = `The run of ${model} was ended while this page had no connection`;
    const opened = recorded === null ? showModel(model) : showRecording(recorded);
    opened.then(() => notify(`${why}. It is opened again, from its start.`), (problem) => notify(`${why}. It cannot be opened again: ${problem.message}`));
  }
}

/** Applies the received updates as soon as drawing is allowed. */
function updateSoon() {
  if (timer) return;
  const { left } = frameBudget;
  if (left === 0) update();
  else timer = setTimeout(again, left);
}

function again() {
  timer = 0;
  updateSoon();
}

function update() {
  clearTimeout(timer);
  timer = 0;
  const messages = updates.splice(0);
  frameBudget.drawing();
  take(messages);
  frameBudget.hurried = hurried.peek();
  for (const { replies = [] } of messages) {
    for (const reply of replies) {
      const { resolve, reject } = settled(reply.id);
      if (reply.error === null) resolve?.(reply.result);
      else reject?.(Object.assign(new Error(reply.error), { loses: reply.loses, field: reply.field }));
    }
  }
}

/** Functions that send what waits for an earlier answer; it is sent before any other command. */
export const unsent = new Set();

/** Sends a command or a question; returns its result, or throws an Error with the reason, with `loses` if only because something would be lost,
 * and with the `field` because of whose value it was refused: the message begins with the name of the field. */
export function request(what) {
  return new Promise((resolve, reject) => {
    if (shown === null || socket?.readyState !== WebSocket.OPEN) {
      reject(new Error(shown === null ? "no run is shown" : "there is no connection to the workbench"));
      return;
    }
    for (const send of unsent) send();
    number += 1;
    waiting.set(number, { resolve, reject, answered: awaited() });
    socket.send(JSON.stringify({ id: number, command: what }));
  });
}

/** Sends a command whose result does not matter; shows errors among the messages, unless the page shows another run by now. */
export function sendCommand(what) {
  return request(what).catch((error) => isLeft(error) || notify(error.message));
}
