"use strict";
// Soft shadows on the ground under the parts of shapes that are on it or near it, as in the workbench (`backdrop.py` there).

const HIGHEST = 2; // parts higher above the ground than this cast none [m]
const DARKEST = 0.36, FADING = 0.45; // the darkness at the ground, and the height at which it falls to about a third [m]
const SOFT = 0.1, SOFTER = 0.4; // how far a shadow extends beyond its part, and how much farther for each metre of height [m]
const MAX_SHADES = 64;

// The box around a part: its pose in the frame of its shape, its middle and its half sides.
function boxOf(part, meshes) {
  const { places } = part.kind === "mesh" ? meshes[part.mesh] : SOLIDS[part.kind](...part.size);
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  places.forEach((place, n) => {
    low[n % 3] = Math.min(low[n % 3], place);
    high[n % 3] = Math.max(high[n % 3], place);
  });
  return { pose: poseMatrix([...part.place, ...part.turn]), middle: low.map((least, axis) => (least + high[axis]) / 2), half: minus(high, low).map((side) => side / 2) };
}

// The shadow of a box in the frame of a shape: x, y, direction of the first side (cosine, sine), two half sides, softness, darkness.
function shadeOf({ pose, middle, half }, shape, ground) {
  const whole = times(shape, pose), column = (n) => [whole[4 * n], whole[4 * n + 1], whole[4 * n + 2]];
  const sides = [0, 1, 2].map((n) => column(n).map((part) => part * half[n]));
  const at = [0, 1, 2].reduce((place, n) => plus(place, column(n), middle[n]), column(3));
  const low = at[2] - sides.reduce((sum, side) => sum + Math.abs(side[2]), 0) - ground, under = Math.max(low, 0);
  const dark = Math.abs(low) < HIGHEST ? DARKEST * Math.exp(-under / FADING) : 0;
  const flat = ([x, y]) => Math.hypot(x, y);
  const longest = sides.reduce((one, other) => (flat(other) > flat(one) ? other : one)), length = flat(longest);
  const [c, s] = length > 1e-9 ? [longest[0] / length, longest[1] / length] : [1, 0];
  const reach = (x, y) => sides.reduce((sum, side) => sum + Math.abs(side[0] * x + side[1] * y), 0);
  return [at[0], at[1], c, s, reach(c, s), reach(-s, c), SOFT + SOFTER * under, dark];
}

// The darkest shadows of shapes, each given by its boxes and its pose.
function shadesOf(shapes, ground) {
  const all = shapes.flatMap(({ boxes, pose }) => boxes.map((box) => shadeOf(box, pose, ground)));
  return all.filter((shade) => shade[7] > 0.01).sort((one, other) => other[7] - one[7]).slice(0, MAX_SHADES);
}
