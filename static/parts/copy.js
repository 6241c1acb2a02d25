// A button that copies text to the clipboard, and confirms it on itself.

import { computed, html, signal, useMemo } from "../vendor/preact.js";
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

/** Returns {isShown, confirm}: a signal that is true for a while after each `confirm`. */
export function confirmation() {
  const count = signal(0); // how many are shown
  function confirm() {
    count.value += 1;
    setTimeout(() => (count.value -= 1), SHOWN);
  }
  return { isShown: computed(() => count.value > 0), confirm };
}

/** @param text The button's text. @param copied Returns the text to copy, or a promise of it. @param title The tooltip. */
export function CopyButton({ text, copied, disabled = false, title = undefined }) {
  const { isShown, confirm } = useMemo(confirmation, []);
  const copy = async () => (await copyText(copied())) && confirm();
  const done = isShown.value;
  // As wide as the longer text, so that nothing moves.
  return html`<${Button} class="copy ${done ? "done" : ""}" disabled=${disabled} title=${title} onClick=${copy}>
    <${Icon} name=${done ? "check" : "copy"} /><span>${text}</span><span class="said" role="status">${done ? "Copied" : ""}</span>
  <//>`;
}
