// The latest problem, shown for a while over the page; all problems stay in the tab Messages.

import { html, signal, useEffect } from "../vendor/preact.js";
import { isSettled, notices, session, settle } from "../store.js";
import { openTab } from "../open_tab.js";

const SHOWN = 8000; // [ms]
const toast = signal(null);

export function Toasts() {
  const list = notices.value;
  useEffect(() => {
    if (list.length === 0) return;
    // A newer attempt settles the notices of earlier ones.
    const isOpen = ({ level, attempt }) => level === "error" && (attempt === undefined || attempt === session.peek()?.attempt);
    const fresh = list.filter((notice) => isOpen(notice) && !isSettled(notice, "shown"));
    settle("shown");
    if (fresh.length > 0 && openTab.peek() !== "messages") toast.value = fresh.at(-1);
  }, [list]);
  const shown = toast.value; // a message of a previously shown run no longer matters
  useEffect(() => {
    if (!shown) return undefined;
    const timer = setTimeout(() => (toast.value = null), SHOWN);
    return () => clearTimeout(timer);
  }, [shown]);

  function read() {
    toast.value = null;
    openTab.value = "messages";
  }

  return html`<div class="toasts" aria-live="assertive">
    ${list.includes(shown) && openTab.value !== "messages"
      ? html`<div class="toast">
          <span>${shown.file ? `${shown.file}:${shown.line}: ` : ""}${shown.text}</span>
          <button class="bare" onClick=${read}>Show</button>
          <button class="bare" aria-label="Close" onClick=${() => (toast.value = null)}>✕</button>
        </div>`
      : null}
  </div>`;
}
