// The latest problem, or message that offers an action, shown for a while over the page; all problems stay in the tab Messages.

import { html, signal, useEffect, useRef, useSignal } from "../vendor/preact.js";
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
  const isHeld = useSignal(false);
  useEffect(() => {
    if (!shown || isHeld.value) return undefined;
    const timer = setTimeout(() => (toast.value = null), SHOWN);
    return () => clearTimeout(timer);
  }, [shown, isHeld.value]);
  return html`<div class="toasts" aria-live="assertive">
    ${list.includes(shown) && isPresent(shown) && openTab.value !== "messages" ? html`<${Toast} notice=${shown} isHeld=${isHeld} />` : null}
  </div>`;
}

/** A notice; `isHeld` is set while the pointer or the focus is in it. */
function Toast({ notice, isHeld }) {
  const place = useRef(null);
  const close = () => (toast.value = null);
  const leave = () => (isHeld.value = place.current?.matches(":hover, :focus-within"));
  useEffect(() => () => (isHeld.value = false), []);

  function read() {
    close();
    goToTab("messages");
  }

  function act() {
    close();
    takeAction(notice);
  }

  const hold = () => (isHeld.value = true);
  return html`<div ref=${place} class="toast ${notice.level}" onPointerEnter=${hold} onPointerLeave=${leave} onFocusIn=${hold} onFocusOut=${leave}>
    <span>${notice.file ? html`<${Place} file=${notice.file} line=${notice.line} /> ` : null}${notice.text}</span>
    ${notice.action ? html`<${Button} onClick=${act}>${notice.action.text}<//>` : null}
    <${Button} class="bare" onClick=${read}>Show<//>
    <${Button} class="bare" aria-label="Close" onClick=${close}>✕<//>
  </div>`;
}
