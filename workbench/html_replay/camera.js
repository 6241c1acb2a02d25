"use strict";
// The camera of the replay. At first it sees the body from behind, with everything around it, as in the workbench.

const FOV = (50 * Math.PI) / 180; // the vertical field of view
const ASIDE = (10 * Math.PI) / 180; // the first view's angle to the side
const RAISED = (25 * Math.PI) / 180; // its angle from above
const ROOM = 1.06; // its distance, as a multiple of the smallest that shows everything

class Camera {
  // The places are those of the body in turn, [x, y]: it follows a body that leaves the stage.
  constructor(stage, places) {
    this.stage = stage;
    this.start = places[0] || [0, 0];
    const [x, y] = stage.ahead, c = Math.cos(ASIDE), s = Math.sin(ASIDE);
    this.turn = Math.atan2(-(c * y + s * x), -(c * x - s * y));
    this.tilt = RAISED;
    this.shifted = [0, 0, 0];
    this.nearer = 1;
    this.following = places.some((place) => place.some((value, axis) => value < stage.low[axis] || value > stage.high[axis]));
    this.off = [0, 0, 0];
    this.from = this.back(); // at first, for which the stage is fitted into the picture
    this.fitted = {};
  }

  back() {
    const flat = Math.cos(this.tilt);
    return [flat * Math.cos(this.turn), flat * Math.sin(this.turn), Math.sin(this.tilt)];
  }

  // Returns the target and the distance at which the whole stage is in view, computed for the first viewing direction.
  fit(aspect) {
    const { low, high, corners } = this.stage, middle = low.map((value, axis) => (value + high[axis]) / 2);
    const back = this.from, right = unit(cross([0, 0, 1], back)), upward = Math.tan(FOV / 2);
    const sideward = upward * Math.min(Math.max(aspect, 0.7), 2.5);
    let target = middle, distance = 0;
    // What is between two rays through the outermost corners is in the middle of the picture.
    for (const [axis, edge] of [[cross(back, right), upward], [right, sideward]]) {
      let above = -Infinity, below = Infinity;
      for (const corner of corners) {
        const from = minus(corner, middle), place = dot(from, axis), near = edge * dot(from, back);
        above = Math.max(above, place + near);
        below = Math.min(below, place - near);
      }
      target = plus(target, axis, (above + below) / 2);
      distance = Math.max(distance, (above - below) / 2 / edge);
    }
    return { target, distance: distance * ROOM };
  }

  // Returns the camera's position, its target, and the matrix that projects the scene. While it follows, the body keeps its place in the picture.
  seen(body, aspect) {
    if (this.following) this.off = [body[0] - this.start[0], body[1] - this.start[1], 0];
    if (this.fitted.aspect !== aspect) this.fitted = { aspect, ...this.fit(aspect) };
    const { target: middle, distance } = this.fitted;
    this.distance = distance * this.nearer;
    const target = plus(plus(middle, this.off, 1), this.shifted, 1), eye = plus(target, this.back(), this.distance);
    return { eye, target, view: times(perspective(FOV, aspect, 0.05, 200), lookAt(eye, target)) };
  }

  swing(x, y) {
    this.turn -= x * 0.008;
    this.tilt = Math.min(1.5, Math.max(-0.2, this.tilt + y * 0.006));
  }

  // Moves the target; x and y are fractions of the picture's height.
  shift(x, y) {
    const size = this.distance * 2 * Math.tan(FOV / 2), s = Math.sin(this.turn), c = Math.cos(this.turn);
    this.shifted = plus(this.shifted, [x * s - y * c, -x * c - y * s, 0], size);
  }

  near(by) {
    this.nearer = Math.min(20, Math.max(0.05, this.nearer * Math.exp(by * 0.001)));
  }
}
