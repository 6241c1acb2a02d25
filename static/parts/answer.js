// Questions to a run, sent again whenever the run is at another moment.

import { useEffect, useRef, useState, effect } from "../vendor/preact.js";
import { say } from "../server.js";
import { alive, moment, running, session, whichRun } from "../store.js";

/** The interval between two questions while the run is active [ms]: answering slows the run down. */
const WHILE_RUNNING = 100;

const NOTHING = { answer: null, error: null, waiting: false, of: null };

/**
 * Sends a question of `page_commands` now and whenever the run is at another moment; one question at a time.
 *
 * @param question The question; null for none.
 * @param live Whether it is also sent while the run is active.
 * @param once Whether it is sent once while the run is active, such as a question about a past moment.
 * @returns {answer, error, waiting}: the newest answer (kept until the next one arrives, but not for another run), or why
 *   there is none.
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
      const run = whichRun();
      const of = run;
      setResult((before) => ({ ...before, waiting: true }));
      const news = await say(question).then(
        (answer) => ({ answer, error: null, of }),
        (error) => ({ answer: null, error: error.message, of }),
      );
      if (over || newest.current !== key) return;
      setResult((before) => ({ ...before, ...(run === whichRun() ? news : {}), waiting: false })); // an answer of another run is ignored
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
  const shown = `${session.value?.id} ${session.value?.run}`; // as `whichRun`, but followed
  return result.of === null || result.of === shown ? result : NOTHING;
}
