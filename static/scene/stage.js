// Where a camera stands so that what it is to show is in its picture: numbers only, so that tests can compute with them.

import { cross, dot, minus, plus, unit } from "./space.js";

/** From where the scene can be seen, with titles. */
export const VIEWS = { follow: "with the body", free: "free", side: "from the side", top: "from above", eye: "through the eye" };
export const FOV = (50 * Math.PI) / 180; // the vertical field of view, except through an eye
const DEGREE = Math.PI / 180;
const ROOM = 1.06; // how much farther away than necessary a camera stands
const BODY_PART = 0.4; // how much of the picture's height the body takes where the camera goes with it
const FARTHEST = 1.6; // to have the doorway in the picture, too, the camera stands at most this many times as far away

/** Returns the direction from what is seen to a camera behind it: so far to the side and so far above [degrees]. */
function behind([x, y], aside, raised) {
  const [c, s, flat] = [Math.cos(aside * DEGREE), Math.sin(aside * DEGREE), Math.cos(raised * DEGREE)];
  return [-flat * (c * x - s * y), -flat * (c * y + s * x), Math.sin(raised * DEGREE)];
}

/** Returns the right and the upward direction of the picture of a camera in the direction `back`. */
function axesOf(back) {
  const right = unit(cross([0, 0, 1], back));
  return [right, cross(back, right)];
}

/** Returns the middle of the corners as a camera sees them, and its distance so that all are in the picture; without perspective, `distance` is
 * that at which the field of view would be as large. */
function fitted(corners, back, aspect, flat) {
  const [right, up] = axesOf(back);
  const upward = Math.tan(FOV / 2);
  const middle = [0, 1, 2].map((axis) => corners.reduce((sum, corner) => sum + corner[axis], 0) / corners.length);
  let target = middle;
  let distance = 0.1;
  for (const [axis, edge] of [[up, upward], [right, upward * Math.min(Math.max(aspect, 0.5), 3)]]) {
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

/** Returns how far behind the body a camera stands that goes with it: the corners of the stage are in its picture, too, if the body does not
 * become small by that. */
function following(stage, target, back, aspect) {
  const [right, up] = axesOf(back);
  const upward = Math.tan(FOV / 2);
  const least = stage.height / 2 / BODY_PART / upward;
  let distance = least;
  for (const corner of stage.corners) {
    const from = minus(corner, target);
    const near = dot(from, back);
    distance = Math.max(distance, near + ROOM * Math.max(Math.abs(dot(from, up)) / upward, Math.abs(dot(from, right)) / upward / aspect));
  }
  return Math.min(distance, FARTHEST * least);
}

/** Returns the place that a view goes along with: the middle of the body, or how far the body has left the stage. */
export function anchorOf(view, stage, body) {
  if (view === "follow") return plus(body, stage.middle);
  return [0, 1].map((axis) => body[axis] - Math.min(Math.max(body[axis], stage.low[axis]), stage.high[axis])).concat(0);
}

/**
 * Returns where the camera of a view stands at first: what it looks at, the direction from there to the camera, how far away it is, and
 * whether its picture is without perspective (`flat`).
 * @param aspect The width of the picture by its height.
 * @param room How much of its width nothing of the page covers, from the left.
 */
export function standing(view, stage, body, aspect, room = 1) {
  const { ahead } = stage;
  const anchor = anchorOf(view, stage, body);
  if (view === "follow") {
    const back = behind(ahead, 7, 18);
    return { target: anchor, back, distance: following(stage, plus(stage.start, stage.middle), back, aspect), flat: false };
  }
  const flat = view !== "free";
  // From above and from the side, what is ahead is to the right, where windows have most room.
  const back = { free: behind(ahead, 10, 25), top: unit([0.001 * ahead[1], -0.001 * ahead[0], 1]), side: [ahead[1], -ahead[0], 0] }[view];
  const { target, distance } = fitted(stage.corners, back, aspect * room, flat);
  const aside = (1 - room) * aspect * distance * Math.tan(FOV / 2);
  return { target: plus(plus(target, anchor), axesOf(back)[0], aside), back, distance, flat };
}
