// Speaks to the server: REST for files, sessions and recordings; one websocket for a session's state and commands.

import { changed, forget, store, take } from "./store.js";

const AGAIN = 1000; // how long it waits before connecting again [ms]

let socket = null;
let shown = null;
let number = 0;
const waiting = new Map();

/** Calls the REST interface; returns what it tells, or throws an Error that says why not, with `status` and `told`. */
export async function call(method, path, body) {
  const headers = body === undefined ? {} : { "content-type": "application/json", "x-workbench": "1" };
  if (method !== "GET" && body === undefined) {
    headers["content-type"] = "application/json";
    headers["x-workbench"] = "1";
  }
  const response = await fetch(path, { method, headers, body: body === undefined ? undefined : JSON.stringify(body) });
  const text = await response.text();
  let told = null;
  try {
    told = JSON.parse(text);
  } catch {
    told = { error: text };
  }
  if (!response.ok) {
    const reason = typeof told.error === "string" ? told.error : JSON.stringify(told.detail ?? told);
    throw Object.assign(new Error(reason), { status: response.status, told });
  }
  return told;
}

/** Shows a session from now on. */
export function show(session) {
  if (session !== shown) forget();
  shown = session;
  if (socket?.readyState === WebSocket.OPEN) attach();
  else connect();
}

function attach() {
  const known = store.firstEvent + store.events.length;
  socket.send(JSON.stringify({ type: "attach", session: shown, run: store.run, epoch: store.epoch, events: known }));
}

function connect() {
  if (socket && socket.readyState <= WebSocket.OPEN) return;
  socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/ws`);
  socket.onopen = () => {
    store.connected = true;
    changed("connected");
    if (shown) attach();
  };
  socket.onmessage = ({ data }) => {
    const message = JSON.parse(data);
    if (message.type !== "update") return;
    take(message);
    for (const reply of message.replies ?? []) {
      waiting.get(reply.id)?.(reply);
      waiting.delete(reply.id);
    }
  };
  socket.onclose = () => {
    store.connected = false;
    changed("connected");
    for (const done of waiting.values()) done({ result: null, error: "the connection was lost" });
    waiting.clear();
    setTimeout(connect, AGAIN);
  };
}

/** Says a command or asks a question; returns what comes of it. What goes wrong is among the messages. */
export function say(what) {
  return new Promise((resolve, reject) => {
    if (socket?.readyState !== WebSocket.OPEN) {
      reject(new Error("there is no connection"));
      return;
    }
    number += 1;
    waiting.set(number, ({ result, error }) => (error === null ? resolve(result) : reject(new Error(error))));
    socket.send(JSON.stringify({ id: number, say: what }));
  });
}

/** Does a command whose result does not matter; an error is shown among the messages. */
export function order(what) {
  return say(what).catch((error) => complain(error.message));
}

let ownNotices = 0;

export function complain(text) {
  ownNotices -= 1;
  store.notices.push({ number: ownNotices, level: "error", text, file: null, line: null, detail: "" });
  changed("notices");
}
