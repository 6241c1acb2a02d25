// A button that may become unavailable, for example by its own press.

import { html, useRef, useState } from "../vendor/preact.js";

/** A `button` that keeps the focus while it is disabled: the browser would take it away, and a screen reader would continue at the top of
 * the page. Once the focus leaves it, it is disabled as any other.
 *
 * @param button A ref, for the element. */
export function Button({ button, disabled = false, onClick, children, ...others }) {
  const own = useRef(null);
  const box = button ?? own;
  const [, setBlurs] = useState(0);
  const isKept = Boolean(disabled) && document.activeElement !== null && document.activeElement === box.current;
  const refuse = (event) => event.preventDefault(); // a form is not sent, and nothing opens
  return html`<button ...${others} ref=${box} disabled=${Boolean(disabled) && !isKept} aria-disabled=${isKept ? "true" : undefined} onClick=${isKept ? refuse : onClick} onBlur=${isKept ? () => setBlurs((blurs) => blurs + 1) : undefined}>${children}</button>`;
}
