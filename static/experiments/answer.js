// Asks the server for something of an experiment, and again when the experiment has gone on.

import { useEffect, useRef, useSignal } from "../vendor/preact.js";
import { call } from "../server.js";

const BETWEEN = 1000; // the least interval between two requests [ms]

/**
 * Returns {answer, error, waiting}; the answer to the previous question stays until the next one arrives.
 *
 * @param path What is asked for; null for nothing.
 * @param version Whatever changes when the answer may be another one.
 */
export function useFresh(path, version) {
  const found = useSignal({ path: null, answer: null, error: null, waiting: false });
  const last = useRef({ path: null, at: 0 });
  useEffect(() => {
    if (path === null) return undefined;
    const leave = new AbortController();
    async function ask() {
      last.current = { path, at: Date.now() };
      if (found.peek().path !== path) found.value = { ...found.peek(), waiting: true };
      try {
        const answer = await call("GET", path, undefined, leave.signal);
        found.value = { path, answer, error: null, waiting: false };
      } catch (error) {
        if (!leave.signal.aborted) found.value = { path, answer: null, error: error.message, waiting: false };
      }
    }
    const pause = last.current.path === path ? Math.max(0, last.current.at + BETWEEN - Date.now()) : 0;
    const timer = setTimeout(ask, pause);
    return () => (clearTimeout(timer), leave.abort());
  }, [path, version]);
  return found.value;
}
