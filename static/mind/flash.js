// Shows that something has changed: it lights up once, also where it goes on changing.

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { session } from "../store.js";

const CALM = 1200; // so long it must have stayed the same before it lights up again [ms]

/** A text that lights up when it has become another; not for another run. */
export function Flash({ text, class: name = "", children }) {
  const run = `${session.value?.id} ${session.value?.run}`;
  const before = useRef({ text, run });
  const timer = useRef(0);
  const [changed, setChanged] = useState(false);
  useEffect(() => {
    const { text: old, run: oldRun } = before.current;
    before.current = { text, run };
    if (old === text || oldRun !== run) return;
    setChanged(true);
    clearTimeout(timer.current);
    timer.current = setTimeout(() => setChanged(false), CALM);
  }, [text, run]);
  useEffect(() => () => clearTimeout(timer.current), []);
  return html`<span class="${name} ${changed ? "changed" : ""}">${children ?? text}</span>`;
}
