// A bar between two panels that moves the border between them, by pointer or by arrow keys.

import { html } from "../vendor/preact.js";

const STEP = 24; // the step of an arrow key [px]

/**
 * @param size A signal with the size that it sets [px].
 * @param along "columns" for a bar between left and right, "rows" for one between above and below.
 * @param label The name of the panel whose size it sets.
 * @param least The minimum size [px].
 * @param most Returns the maximum size [px].
 * @param reversed Whether the panel whose size it sets comes before the bar: left of it, or above; otherwise after it.
 */
export function Splitter({ size, along, label, least, most, reversed = false }) {
  const clamp = (value) => Math.round(Math.max(least, Math.min(most(), value)));
  const now = () => clamp(size.value); // in a small window, less than what was chosen
  const place = (event) => (along === "columns" ? event.clientX : event.clientY);

  function begin(event) {
    const bar = event.currentTarget;
    const from = place(event);
    const before = now();
    bar.setPointerCapture(event.pointerId);
    document.body.dataset.dragging = along; // frames receive no pointer events meanwhile
    bar.onpointermove = (moved) => (size.value = clamp(before + (reversed ? place(moved) - from : from - place(moved))));
    bar.onpointerup = bar.onpointercancel = () => {
      bar.onpointermove = bar.onpointerup = bar.onpointercancel = null;
      delete document.body.dataset.dragging;
    };
    event.preventDefault();
  }

  function press(event) {
    const keys = along === "columns" ? ["ArrowLeft", "ArrowRight"] : ["ArrowUp", "ArrowDown"];
    const [larger, smaller] = reversed ? keys.reverse() : keys;
    const to = { [larger]: now() + STEP, [smaller]: now() - STEP, Home: least, End: most() }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    size.value = clamp(to);
  }

  return html`<div
    class="splitter ${along}"
    role="separator"
    tabindex="0"
    aria-label=${label}
    aria-orientation=${along === "columns" ? "vertical" : "horizontal"}
    aria-valuenow=${now()}
    aria-valuemin=${least}
    aria-valuemax=${most()}
    onPointerDown=${begin}
    onKeyDown=${press}
  ></div>`;
}
