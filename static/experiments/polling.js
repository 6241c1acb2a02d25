// Asks the server for something of an experiment, and again when the experiment has gone on.

import { useEffect, useRef, useSignal } from "../vendor/preact.js";
import { call } from "../server.js";
import { pathOf } from "./list.js";

const BETWEEN = 1000; // the least interval between two requests [ms]

/** Asks one question, at most once at a time, and rests after each answer for at least twice as long as it took. */
class Poller {
  constructor(path, found) {
    this.path = path;
    this.found = found;
    this.leave = new AbortController();
    this.busy = false;
    this.again = false; // whether it was to ask while it was busy
  }

  async ask() {
    if (this.busy) return void (this.again = true);
    this.busy = true;
    const begun = Date.now();
    const answer = await call("GET", this.path, undefined, this.leave.signal).then((answer) => ({ answer, error: null }), (error) => ({ answer: this.last(), error: error.message }));
    if (this.leave.signal.aborted) return;
    this.found.value = { path: this.path, ...answer, waiting: false };
    setTimeout(() => this.rested(), Math.max(BETWEEN, 2 * (Date.now() - begun)));
  }

  /** Returns the last answer to this question: it stays also if the server cannot answer for a while. */
  last() {
    const { path, answer } = this.found.peek();
    return path === this.path ? answer : null;
  }

  rested() {
    this.busy = false;
    if (!this.again || this.leave.signal.aborted) return;
    this.again = false;
    this.ask();
  }
}

/**
 * Returns {answer, error, waiting}; the answer to the previous question stays until the next one arrives.
 *
 * @param path What is asked for; null for nothing.
 * @param version Whatever changes when the answer may be another one.
 */
export function usePolled(path, version) {
  const found = useSignal({ path: null, answer: null, error: null, waiting: false });
  const asker = useRef(null);
  useEffect(() => {
    asker.current = path === null ? null : new Poller(path, found);
    if (path !== null) found.value = { ...found.peek(), waiting: true };
    return () => asker.current?.leave.abort();
  }, [path]);
  useEffect(() => void asker.current?.ask(), [path, version]);
  return found.value;
}

/** Reads the facts of an experiment, which do not change while it runs; returns {facts, error}, null for facts that are not known yet, or for no
 * experiment. */
export function useFacts(experiment) {
  const wanted = experiment && pathOf(experiment.id);
  const { path, answer, error } = usePolled(wanted, experiment?.state);
  return path === wanted ? { facts: answer?.facts ?? null, error } : { facts: null, error: null };
}
