// Draws what an eye sees: extents by row, in the colours of the scene, nearer to the background with distance.

import { scaled } from "../parts/surface.js";
import { colour } from "../theme.js";

const FAR = 12; // from this distance on, colours no longer change [m]
const PALEST = 0.6; // the share of the background in the colour of distant objects
const GROUNDS = { light: 255, dark: 24 }; // about the colour `field`, as a grey

const EDGE = 0.6; // the brightness of an object's edges, as a fraction of its own
const MIN_EDGED = 4; // narrower extents have no edges [pixels]

/** Returns a colour such as `#5b7fa6` as at a distance [m]: nearer to the background with distance. `brightness` darkens it. */
export function shadeOf(hex, distance, dark, brightness = 1) {
  const far = PALEST * Math.min(1, distance / FAR);
  const ground = GROUNDS[dark ? "dark" : "light"];
  const mixed = [1, 3, 5].map((at) => Math.round(parseInt(hex.slice(at, at + 2), 16) * brightness * (1 - far) + ground * far));
  return `rgb(${mixed.join(" ")})`;
}

/** Draws a view ({rows, extents, colours}); an extent begins with row, label, y, x1, x2, d1, d2, see `EXTENT_FIELDS` of the camera. `chosen` is a
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
    const hex = view.colours[label];
    if (Math.abs(d1 - d2) < 0.05) {
      context.fillStyle = shadeOf(hex, d1, dark);
    } else {
      const fade = context.createLinearGradient(left, 0, left + wide, 0);
      fade.addColorStop(0, shadeOf(hex, d1, dark));
      fade.addColorStop(1, shadeOf(hex, d2, dark));
      context.fillStyle = fade;
    }
    context.fillRect(left, top, wide, tall);
    if (wide >= MIN_EDGED) {
      context.fillStyle = shadeOf(hex, d1, dark, EDGE);
      context.fillRect(left, top, 1, tall);
      context.fillStyle = shadeOf(hex, d2, dark, EDGE);
      context.fillRect(left + wide - 1, top, 1, tall);
    }
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
