// Questions to a run, sent again whenever the run is at another moment.

import { useEffect, useRef, useState, effect } from "../vendor/preact.js";
import { request } from "../server.js";
import { alive, moment, running, shownRun, state } from "../store.js";

/** The interval between two questions while the run is active [ms]: answering slows the run down. */
const WHILE_RUNNING = 100;

const NOTHING = { answer: null, error: null, waiting: false, of: null, key: null, time: null };

/**
 * Sends a question of `page_commands` now and whenever the run is at another moment; one question at a time.
 *
 * @param question The question; null for none.
 * @param live Whether it is also sent while the run is active.
 * @param once Whether it is sent once while the run is active, such as a question about a past moment.
 * @returns {answer, error, waiting, time}: the newest answer, or why there is none, and the time [s] of the run when it was asked. That of
 *   another question is kept until the next one arrives, if one can; never that of another run.
 */
export function useAnswer(question, { live = false, once = false } = {}) {
  const [result, setResult] = useState(NOTHING);
  const key = JSON.stringify(question);
  const newest = useRef(key);
  newest.current = key;
  useEffect(() => {
    if (question === null) return undefined;
    let asked = "";
    let busy = false;
    let over = false;
    let timer = 0;
    async function ask() {
      if (busy || over || !alive.peek() || (running.peek() && !live && !(once && asked === "")) || asked === moment.peek()) return;
      asked = moment.peek();
      busy = true;
      const run = shownRun.peek();
      const about = { of: run, key, time: state.peek()?.time ?? null };
      setResult((before) => ({ ...before, waiting: true }));
      const news = await request(question).then(
        (answer) => ({ answer, error: null, ...about }),
        (error) => ({ answer: null, error: error.message, ...about }),
      );
      if (over || newest.current !== key) return;
      setResult((before) => ({ ...before, ...(run === shownRun.peek() ? news : {}), waiting: false })); // an answer of another run is ignored
      busy = false;
      timer = setTimeout(ask, running.peek() ? WHILE_RUNNING : 0);
    }
    const end = effect(() => {
      moment.value;
      running.value;
      if (alive.value) ask();
    });
    return () => {
      over = true;
      clearTimeout(timer);
      end();
      if (busy) setResult((before) => ({ ...before, waiting: false }));
    };
  }, [key, live, once]);
  const shown = shownRun.value;
  const isAsked = question !== null && alive.value && (live || once || !running.value);
  return result.of === null || (result.of === shown && (result.key === key || isAsked)) ? result : NOTHING;
}
