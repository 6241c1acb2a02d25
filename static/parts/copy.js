// A button that copies something to the clipboard, and says on itself that it is there.

import { html, useEffect, useState } from "../vendor/preact.js";
import { complain } from "../store.js";
import { Icon } from "./icon.js";

const SHOWN = 2000; // how long it says so [ms]

/** @param text What is on the button. @param copied Returns what is copied, or a promise of it. @param title What more there is to say. */
export function CopyButton({ text, copied, disabled = false, title = undefined }) {
  const [count, setCount] = useState(0);
  const [done, setDone] = useState(false);
  useEffect(() => {
    if (count === 0) return undefined;
    setDone(true);
    const timer = setTimeout(() => setDone(false), SHOWN);
    return () => clearTimeout(timer);
  }, [count]);

  async function copy() {
    try {
      await navigator.clipboard.writeText(await copied());
      setCount((before) => before + 1);
    } catch (error) {
      setDone(false);
      complain(`Nothing was copied: ${error.name === "NotAllowedError" ? "the browser does not let the page write to the clipboard" : error.message}.`);
    }
  }

  // As wide as with either text, so that nothing moves.
  return html`<button class="copy ${done ? "done" : ""}" disabled=${disabled} title=${title} onClick=${copy}>
    <${Icon} name=${done ? "check" : "copy"} /><span>${text}</span><span class="said" role="status">${done ? "Copied" : ""}</span>
  </button>`;
}
