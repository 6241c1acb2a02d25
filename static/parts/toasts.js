// The latest problem, or message that offers an action, shown for a while over the page; all problems stay in the tab Messages.

import { html, signal, useEffect } from "../vendor/preact.js";
import { isAhead, isPresent, isSettled, notices, settle, takeAction } from "../store.js";
import { goToTab, openTab } from "../open_tab.js";
import { Button } from "./button.js";
import { Place } from "./place.js";

const SHOWN = 8000; // [ms]
const toast = signal(null);

export function Toasts() {
  const list = notices.value.filter((notice) => !isAhead(notice));
  const latest = list.at(-1);
  useEffect(() => {
    if (list.length === 0) return;
    const fresh = list.filter((notice) => (notice.level === "error" || notice.action) && isPresent(notice) && !isSettled(notice, "shown"));
    settle("shown", list);
    if (fresh.length > 0 && openTab.peek() !== "messages") toast.value = fresh.at(-1);
  }, [latest]);
  const shown = toast.value;
  useEffect(() => {
    if (!shown) return undefined;
    const timer = setTimeout(() => (toast.value = null), SHOWN);
    return () => clearTimeout(timer);
  }, [shown]);

  function read() {
    toast.value = null;
    goToTab("messages");
  }

  function act() {
    toast.value = null;
    takeAction(shown);
  }

  return html`<div class="toasts" aria-live="assertive">
    ${list.includes(shown) && isPresent(shown) && openTab.value !== "messages"
      ? html`<div class="toast ${shown.level}">
          <span>${shown.file ? html`<${Place} file=${shown.file} line=${shown.line} /> ` : null}${shown.text}</span>
          ${shown.action ? html`<${Button} onClick=${act}>${shown.action.text}<//>` : null}
          <${Button} class="bare" onClick=${read}>Show<//>
          <${Button} class="bare" aria-label="Close" onClick=${() => (toast.value = null)}>✕<//>
        </div>`
      : null}
  </div>`;
}
