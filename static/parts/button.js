// A button that may become unavailable or disappear, for example by its own press.

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";

const MAX_PLACES = 20; // the number of elements remembered

/** The elements that had the focus, the latest last. */
let places = [];
addEventListener("focusin", ({ target }) => (places = [...places.filter((one) => one !== target), target].slice(-MAX_PLACES)));

/** Moves the focus to the latest of them that is still there, unless something else has it by now. */
function goBack() {
  if (document.activeElement === document.body) places.findLast((one) => one.checkVisibility() && !one.disabled)?.focus({ preventScroll: true });
}

/** A `button` that keeps the focus while it is disabled: the browser would take it away, and a screen reader would continue at the top of
 * the page. Once the focus leaves it, it is disabled as any other. If it disappears while it has the focus by keyboard, the focus returns to
 * where it was before.
 *
 * @param button A ref, for the element. */
export function Button({ button, disabled = false, onClick, children, ...others }) {
  const own = useRef(null);
  const box = button ?? own;
  const [, setBlurs] = useState(0);
  useLayoutEffect(() => () => void (box.current?.matches(":focus-visible") && requestAnimationFrame(goBack)), []);
  const isKept = Boolean(disabled) && document.activeElement !== null && document.activeElement === box.current;
  const refuse = (event) => event.preventDefault(); // a form is not sent, and nothing opens
  return html`<button ...${others} ref=${box} disabled=${Boolean(disabled) && !isKept} aria-disabled=${isKept ? "true" : undefined} onClick=${isKept ? refuse : onClick} onBlur=${isKept ? () => setBlurs((blurs) => blurs + 1) : undefined}>${children}</button>`;
}
