// A menu: a button, and a box that it opens below it; above it, where there is more room.

import { html, useId, useRef } from "../vendor/preact.js";
import { Button } from "./button.js";

const LOW = 0.6; // from this part of the height of the page on, a menu opens upwards
const [GAP, EDGE] = [2, 8]; // to the button, and to the edge of the page [px]

/**
 * @param label What the menu is called.
 * @param title The title of the button.
 * @param name The name of the button: `label`, unless what it shows is its name (null).
 * @param face What the button shows; `look` is its class.
 * @param class The class of the box, besides `menu`; the button has it with `-button`.
 * @param onClick Called when the button is pressed.
 * @param children What it contains: a function of a function that opens the box (true) or closes it (false).
 */
export function Menu({ label, title = label, name = label, face, look = "bare", class: kind, disabled = false, onClick, children }) {
  const id = useId();
  const button = useRef(null);
  const box = useRef(null);

  function place({ newState }) {
    if (newState !== "open") return;
    const { left, right, top, bottom } = button.current.getBoundingClientRect();
    const above = bottom > LOW * innerHeight;
    const toRight = left + right < innerWidth;
    Object.assign(box.current.style, {
      left: toRight ? `${left}px` : "auto",
      right: toRight ? "auto" : `${innerWidth - right}px`,
      top: above ? "auto" : `${bottom + GAP}px`,
      bottom: above ? `${innerHeight - top + GAP}px` : "auto",
      maxHeight: `${(above ? top : innerHeight - bottom) - GAP - EDGE}px`,
    });
  }

  return html`<${Button} button=${button} class="${look} ${kind}-button" popovertarget=${id} aria-label=${name} title=${title} disabled=${disabled} onClick=${onClick}>${face}<//>
    <div ref=${box} id=${id} popover="auto" class="menu ${kind}" role="group" aria-label=${label} onBeforeToggle=${place}>${children((shown) => box.current?.togglePopover(shown))}</div>`;
}
