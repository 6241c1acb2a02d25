// The retina: a picture of what an eye sees; the pointer shows label, position and distance.

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { useSize } from "../parts/size.js";
import { dark } from "../theme.js";
import { drawView, extentAt } from "./drawing.js";

/** Returns an extent in words. */
function extentText([row, label, , x1, x2, d1, d2]) {
  return `label ${label} · row ${row} · x ${x1.toFixed(3)} to ${x2.toFixed(3)} · ${d1.toFixed(2)} m to ${d2.toFixed(2)} m`;
}

/**
 * @param view The answer to the question `view`; null if there is none yet.
 * @param pointed The label of an object to frame; null for that under the pointer.
 */
export function Retina({ view, pointed = null }) {
  const canvas = useRef(null);
  const [under, setUnder] = useState(null);
  const isDark = dark.value;
  const { width, height } = useSize(canvas);
  useLayoutEffect(() => drawView(canvas.current, view, isDark, pointed ?? under?.[1]), [view, isDark, under, pointed, width, height]);

  function point(event) {
    const box = canvas.current.getBoundingClientRect();
    setUnder(extentAt(view, (event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height));
  }

  return html`<div class="retina">
    ${view?.extents.length === 0 ? html`<p class="retina-nothing">Nothing is in view of this eye now.</p>` : null}
    <canvas ref=${canvas} role="img" aria-label="What the eye sees: extents by row" onPointerMove=${point} onPointerLeave=${() => setUnder(null)}></canvas>
    <output class="mono" aria-live="off">${under ? extentText(under) : view ? `${counted(new Set(view.extents.map(([, label]) => label)).size, "object")} in view` : ""}</output>
  </div>`;
}
