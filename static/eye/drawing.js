// Draws what an eye sees: extents by row, coloured by label, nearer to the background with distance.

import { scaled } from "../parts/surface.js";
import { channels, labelColour } from "../scene/palette.js";
import { colour } from "../theme.js";

const FAR = 12; // from this distance on, colours no longer change [m]
const PALEST = 0.6; // the share of the background in the colour of distant objects
const GROUNDS = { light: 255, dark: 24 }; // about the colour `field`, as a grey

/** Returns the colour of a label at a distance [m]: that of its edges in the scene, nearer to the background with distance. */
export function shadeOf(label, distance, dark) {
  const far = PALEST * Math.min(1, distance / FAR);
  const mixed = channels(labelColour(label)).map((part) => Math.round(part * (1 - far) + GROUNDS[dark ? "dark" : "light"] * far));
  return `rgb(${mixed.join(" ")})`;
}

/** Draws a view ({rows, extents}); an extent begins with row, label, y, x1, x2, d1, d2, see `EXTENT_FIELDS` of the camera. `chosen` is a
 * label to frame. */
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

/** Returns the extent at a position on the screen (x and y from 0 to 1), or null. */
export function extentAt(view, x, y) {
  if (!view) return null;
  const row = Math.floor(y * view.rows);
  return view.extents.find(([number, , , x1, x2]) => number === row && x >= x1 && x <= x2) ?? null;
}
