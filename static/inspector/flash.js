// Highlights a change: once, even if further changes follow quickly.

import { html, useEffect, useRef, useState } from "../vendor/preact.js";
import { shownRun } from "../store.js";

const CALM = 1200; // how long the text must stay the same before it is highlighted again [ms]

/** A text that is highlighted when it has changed; but not for another run. */
export function Flash({ text, class: name = "", children }) {
  const run = shownRun.value;
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
