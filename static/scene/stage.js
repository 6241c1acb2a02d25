// Computes the camera positions that show the scene: numbers only, so that tests can use it without a browser.

import { cross, dot, minus, plus, unit } from "./space.js";

/** The views of the scene, with titles. */
export const VIEWS = { follow: "with the body", free: "free", side: "from the side", top: "from above", eye: "through the eye" };
export const FOV = (50 * Math.PI) / 180; // the vertical field of view, except through an eye
const DEGREE = Math.PI / 180;
const ROOM = 1.06; // the distance of a camera relative to the minimum
const BODY_PART = 0.4; // the body's part of the picture's height if the camera follows it
const FARTHEST = 1.6; // to show the doorway too, the camera is at most this many times as far away

/** What the page covers of the picture, from the right and from the top, as parts of its width and height. */
export const NOTHING = { right: 0, top: 0 };

/** Returns the direction from the target to a camera behind it: an angle to the side and an angle above [degrees]. */
function behind([x, y], aside, raised) {
  const [c, s, flat] = [Math.cos(aside * DEGREE), Math.sin(aside * DEGREE), Math.cos(raised * DEGREE)];
  return [-flat * (c * x - s * y), -flat * (c * y + s * x), Math.sin(raised * DEGREE)];
}

/** Returns the right and the upward direction of the picture of a camera in the direction `back`. */
function axesOf(back) {
  const right = unit(cross([0, 0, 1], back));
  return [right, cross(back, right)];
}

/** Returns the tangents of half the angles of view of the part that is not covered: upwards and to the side. */
function edgesOf(aspect, covered) {
  const edge = Math.tan(FOV / 2);
  return [edge * (1 - covered.top), edge * aspect * (1 - covered.right)];
}

/** Returns the middle of the corners as a camera sees them, and the distance at which all are in the picture; without perspective,
 * `distance` is the one at which the field of view would have the same size. */
function fitted(corners, back, [upward, aside], flat) {
  const [right, up] = axesOf(back);
  const middle = [0, 1, 2].map((axis) => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
  let target = middle;
  let distance = 0.1;
  for (const [axis, edge] of [[up, upward], [right, Math.min(Math.max(aside, 0.5 * upward), 3 * upward)]]) {
    let above = -Infinity;
    let below = Infinity;
    for (const corner of corners) {
      const from = minus(corner, middle);
      const near = flat ? 0 : edge * dot(from, back);
      above = Math.max(above, dot(from, axis) + near);
      below = Math.min(below, dot(from, axis) - near);
    }
    target = plus(target, axis, (above + below) / 2);
    distance = Math.max(distance, (above - below) / 2 / edge);
  }
  return { target, distance: distance * ROOM };
}

/** Returns the distance of a camera that follows the body: the corners of the stage are in its picture too, unless the body would
 * become too small. */
function following(stage, target, back, [upward, aside]) {
  const [right, up] = axesOf(back);
  const least = stage.height / 2 / BODY_PART / upward;
  let distance = least;
  for (const corner of stage.corners) {
    const from = minus(corner, target);
    const near = dot(from, back);
    distance = Math.max(distance, near + ROOM * Math.max(Math.abs(dot(from, up)) / upward, Math.abs(dot(from, right)) / aside));
  }
  return Math.min(distance, FARTHEST * least);
}

/** Returns the position that a view follows: the middle of the body, or the offset of a body that has left the stage. */
export function anchorOf(view, stage, body) {
  if (view === "follow") return plus(body, stage.middle);
  return [0, 1].map((axis) => body[axis] - Math.min(Math.max(body[axis], stage.low[axis]), stage.high[axis])).concat(0);
}

/**
 * Returns the start of a view's camera: its target, which is in the middle of the part that is not covered, the direction from there to
 * the camera, their distance, and whether its picture is without perspective (`flat`).
 * @param aspect The width of the picture divided by its height.
 */
export function cameraPose(view, stage, body, aspect, covered = NOTHING) {
  const { ahead } = stage;
  const anchor = anchorOf(view, stage, body);
  const edges = edgesOf(aspect, covered);
  if (view === "follow") {
    const back = behind(ahead, 7, 18);
    return { target: anchor, back, distance: following(stage, plus(stage.start, stage.middle), back, edges), flat: false };
  }
  const flat = view !== "free";
  // From above and from the side, the axis of the world that is nearest to ahead is to the right, because most windows are wide.
  const axis = Math.abs(ahead[0]) >= Math.abs(ahead[1]) ? [Math.sign(ahead[0]), 0] : [0, Math.sign(ahead[1])];
  const back = { free: behind(ahead, 10, 25), top: unit([0.001 * axis[1], -0.001 * axis[0], 1]), side: [axis[1], -axis[0], 0] }[view];
  const { target, distance } = fitted(stage.corners, back, edges, flat);
  return { target: plus(target, anchor), back, distance, flat };
}
