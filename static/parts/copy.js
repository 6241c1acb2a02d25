// A button that copies text to the clipboard, and confirms it on itself.

import { html, useEffect, useState } from "../vendor/preact.js";
import { notify } from "../store.js";
import { Button } from "./button.js";
import { dialog } from "./dialog.js";
import { Icon } from "./icon.js";

const SHOWN = 2000; // how long the confirmation is shown [ms]

/** Copies text, or that of a promise; returns whether it is copied, and complains otherwise. Where the browser gives the page no clipboard,
 * the text is shown, so that the user can copy it. */
export async function copyText(text, otherwise = "Nothing was copied") {
  try {
    const wanted = await text;
    if (!navigator.clipboard) {
      offer(wanted);
      return false;
    }
    await navigator.clipboard.writeText(wanted);
    return true;
  } catch (error) {
    notify(`${otherwise}: ${error.name === "NotAllowedError" ? "the browser does not let the page write to the clipboard" : error.message}.`);
    return false;
  }
}

function offer(text) {
  const body = html`<p>The browser lets a page copy only if its address begins with https, or if the workbench runs on the same machine. Copy the selected text yourself.</p>
    <textarea class="mono" aria-label="Text to copy" readonly data-first rows="8" onFocus=${(event) => event.currentTarget.select()}>${text}</textarea>`;
  dialog({ title: "Copy the text", body });
}

/** @param text The button's text. @param copied Returns the text to copy, or a promise of it. @param title The tooltip. */
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
    if (await copyText(copied())) setCount((before) => before + 1);
    else setDone(false);
  }

  // As wide as the longer text, so that nothing moves.
  return html`<${Button} class="copy ${done ? "done" : ""}" disabled=${disabled} title=${title} onClick=${copy}>
    <${Icon} name=${done ? "check" : "copy"} /><span>${text}</span><span class="said" role="status">${done ? "Copied" : ""}</span>
  <//>`;
}
