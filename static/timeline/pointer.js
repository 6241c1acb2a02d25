// The actions of the pointer, the wheel and the keys on the timeline.

import { reach } from "./branches.js";
import { placeOf, secondsPerPixel, timeOf, viewOf } from "./draw.js";
import { AXIS, chosenColumn, column, plotEndingAt, resize } from "./rows.js";
import { furthest, goTicks, present, seek } from "./seek.js";
import { pan, zoom } from "./view.js";

const GRIP = 4; // the distance at which the border of the column of names, or of a plot, can be dragged [px]
const FINGER = 12; // the same by touch [px]
const HANDLE = 20; // the same for the label of the playhead, in the axis [px]
const STILL = 3; // a pointer that has moved by at most this has clicked [px]
const COLUMN = [70, 360]; // the limits of the column's width [px]
const NOTCH = 0.0015; // the zoom per pixel of the wheel
const LINE = 16; // a line of the wheel [px]
export const FEW = 5; // the ticks of a step with Shift

/** Returns the area at a position of the timeline: "border", "axis", "names", "lanes", or "height" at the lower border of the name of a plot. */
export function partAt(x, y, grip = GRIP) {
  if (Math.abs(x - column.peek()) <= grip) return "border";
  if (x < column.peek()) return y > AXIS && plotEndingAt(y, GRIP) ? "height" : "names";
  return y < AXIS ? "axis" : "lanes";
}

function secondsOf(pixels, stage) {
  return pixels * secondsPerPixel(viewOf(stage.clientWidth));
}

function placeIn(event, stage) {
  const { left, top } = stage.getBoundingClientRect();
  return [event.clientX - left, event.clientY - top];
}

/** Returns the box whose rows scroll below the stage. */
const rowsOf = (stage) => stage.parentElement.parentElement;

/** Starts to scrub, to pan, to scroll the rows by their names, or to set the width of the names or the height of a plot. */
export function begin(event) {
  if (event.button !== 0) return;
  const stage = event.currentTarget;
  let [x, y] = placeIn(event, stage);
  const { scrollTop: top } = rowsOf(stage);
  const there = partAt(x, y, event.pointerType === "touch" ? FINGER : GRIP);
  const resized = there === "height" ? plotEndingAt(y, GRIP) : null;
  const part = there === "axis" && Math.abs(x - placeOf(present.peek(), viewOf(stage.clientWidth))) <= HANDLE ? "lanes" : there;
  const began = x;
  let still = true;
  const move = (moved) => {
    const [to, toY] = placeIn(moved, stage);
    still &&= Math.abs(to - began) <= STILL;
    if (part === "axis" && still) return;
    if (resized) resize(resized.plot, resized.height + toY - y);
    else if (part === "names") rowsOf(stage).scrollTop = top + y - toY;
    else if (part === "border") chosenColumn.value = Math.round(Math.min(Math.max(to, COLUMN[0]), COLUMN[1]));
    else if (part === "axis") pan(secondsOf(x - to, stage), present.peek(), reach.peek());
    else seek(Math.max(0, timeOf(to, viewOf(stage.clientWidth))));
    x = to;
  };
  stage.focus({ preventScroll: true, focusVisible: false });
  stage.setPointerCapture(event.pointerId);
  document.body.dataset.dragging = "";
  if (part === "lanes") move(event);
  stage.onpointermove = move;
  stage.onpointerup = stage.onpointercancel = ({ type }) => {
    if (part === "axis" && still && type === "pointerup") seek(Math.max(0, timeOf(x, viewOf(stage.clientWidth))));
    stage.onpointermove = stage.onpointerup = stage.onpointercancel = null;
    delete document.body.dataset.dragging;
  };
  event.preventDefault();
}

/** Zooms about the pointer; pans with Shift, or if the wheel moves sideways. Over the names, the rows scroll as usual. */
export function turn(event) {
  const stage = event.currentTarget;
  const [x, y] = placeIn(event, stage);
  if (x < column.peek() && y >= AXIS && !event.shiftKey) return;
  event.preventDefault();
  const unit = event.deltaMode === 1 ? LINE : 1;
  const sideways = Math.abs(event.deltaX) > Math.abs(event.deltaY);
  if (sideways || event.shiftKey) pan(secondsOf((sideways ? event.deltaX : event.deltaY) * unit, stage), present.peek(), reach.peek());
  else zoom(Math.exp(event.deltaY * unit * NOTCH), timeOf(Math.max(x, column.peek()), viewOf(stage.clientWidth)), present.peek(), reach.peek());
}

/** Goes to another time by keys, or scrolls. */
export function press(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const ticks = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
  const to = { Home: 0, End: furthest.peek() }[event.key];
  if (ticks !== undefined) goTicks(event.shiftKey ? FEW * ticks : ticks);
  else if (to !== undefined) seek(to);
  else if (event.key === "ArrowDown" || event.key === "ArrowUp") rowsOf(event.currentTarget).scrollBy(0, event.key === "ArrowDown" ? 36 : -36);
  else return;
  event.preventDefault();
}
