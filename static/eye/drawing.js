// Draws what an eye sees: extents by row, coloured by label, paler with distance.

import { scaled } from "../parts/surface.js";
import { colour } from "../theme.js";

const FAR = 12; // from here on nothing gets any paler [m]

/** Returns a hue for a label; hues of labels that follow each other lie far apart. */
export function hueOf(label) {
  return (label * 137.508) % 360;
}

/** Returns the colour of a label at a distance [m]. */
export function shadeOf(label, distance, dark) {
  const far = Math.min(1, distance / FAR);
  return dark ? `hsl(${hueOf(label)} ${65 - 40 * far}% ${68 - 40 * far}%)` : `hsl(${hueOf(label)} ${70 - 40 * far}% ${38 + 46 * far}%)`;
}

/** Draws a view ({rows, extents}: each [row, label, y, x1, x2, d1, d2, a1, a2]); `chosen` is a label to be framed. */
export function drawView(canvas, view, dark, chosen = null) {
  const { clientWidth: width, clientHeight: height } = canvas;
  const context = scaled(canvas, width, height);
  context.fillStyle = colour("field");
  context.fillRect(0, 0, width, height);
  if (!view) return;
  const row = height / view.rows;
  for (const [number, label, , x1, x2, d1, d2] of view.extents) {
    const top = Math.floor(number * row);
    const tall = Math.ceil((number + 1) * row) - top;
    const left = x1 * width;
    const wide = Math.max(1, (x2 - x1) * width);
    if (Math.abs(d1 - d2) < 0.05) {
      context.fillStyle = shadeOf(label, d1, dark);
    } else {
      const fade = context.createLinearGradient(left, 0, left + wide, 0);
      fade.addColorStop(0, shadeOf(label, d1, dark));
      fade.addColorStop(1, shadeOf(label, d2, dark));
      context.fillStyle = fade;
    }
    context.fillRect(left, top, wide, tall);
    if (label === chosen) {
      context.fillStyle = colour("text");
      context.fillRect(left, top, 2, tall);
      context.fillRect(left + wide - 2, top, 2, tall);
    }
  }
}

/** Returns the extent at a place of the screen (x and y from 0 to 1), or null. */
export function extentAt(view, x, y) {
  if (!view) return null;
  const row = Math.floor(y * view.rows);
  return view.extents.find(([number, , , x1, x2]) => number === row && x >= x1 && x <= x2) ?? null;
}
