// Draws the timeline on a surface: the axis, the lanes with their bands, the plots.

import { drawCurves, drawTimes, valueAt } from "../parts/curve.js";
import { cut, cutMiddle, widthOf } from "../parts/surface.js";
import { numberText } from "../parts/ticks.js";
import { bodies } from "../store.js";
import { chunkCurve, colourOf, headingOf, titleOf } from "./curves.js";
import { bandText } from "./lanes.js";
import { firstWhere, nextWhere } from "../parts/search.js";
import { AXIS, column, MARGIN, NAME, PLOT } from "./rows.js";
import { span } from "./view.js";

const SCALE = 44; // the width of a plot's scale in the column of names [px]
const THIN = 3; // the width up to which a band is only a stroke [px]
const ROOM = 34; // the minimum width for a text [px]
const SMALL = { size: 10 };
const BESIDE = 6; // between the name of a curve and its value [px]
const VALUE = 34; // the usual width of a value [px]
const LETTER = 7; // the width of a letter of a mark's text, rounded up [px]

/**
 * @typedef Scene
 * @property {number} width [px]
 * @property {number} height [px]
 * @property {number} column The width of the column of names [px].
 * @property {number} scroll The scroll position of the rows [px].
 * @property {{from: number, to: number}} span The visible times [s].
 * @property {{rows: object[]}} layout See `layout` of rows.js.
 * @property {number} present The time of the playhead [s].
 * @property {boolean} running Whether the run is active: then the newest values of curves are on their way.
 * @property {number} period The length of a tick [s].
 * @property {number} end The end of bands that are still open [s].
 * @property {{from: number, to: number}} [now] The position of the playhead's label [px]; absent without one.
 * @property {number} begin Earlier times are not known [s].
 * @property {number} known Later times are not known [s].
 * @property {boolean} fetching Whether events are being requested.
 */

/** Returns the part of a scene of a given width [px] that maps times to positions, now: {column, width, span}. */
export function viewOf(width) {
  return { column: column.value, width, span: span.value };
}

/** Returns the position of a time [px]. */
export function placeOf(time, view) {
  return view.column + MARGIN + (time - view.span.from) / secondsPerPixel(view);
}

/** Returns the time at a position [s]. */
export function timeOf(x, view) {
  return view.span.from + (x - view.column - MARGIN) * secondsPerPixel(view);
}

/** Returns the duration of a pixel [s]. */
export function secondsPerPixel({ column, width, span }) {
  return (span.to - span.from) / Math.max(1, width - column - MARGIN);
}

/** Returns the times from the column of names to the right edge [s], including the margin. */
function wholeSpan(scene) {
  return { from: timeOf(scene.column, scene), to: scene.span.to };
}

export function drawTimeline(surface, scene) {
  const { width, height, column, span, layout, scroll } = scene;
  surface.within(0, AXIS, width, height - AXIS, () => {
    for (const row of layout.rows) {
      const y = row.y - scroll;
      if (y + row.height < AXIS || y > height) continue;
      if (row.begins) surface.line([0, y - 2.5, width, y - 2.5], "line");
      if (row.plot) drawPlotRow(surface, row, y, scene);
      else drawLane(surface, row, y, scene);
    }
  });
  if (scene.begin > span.from) drawUnknown(surface, scene, column, Math.min(width, placeOf(scene.begin, scene)), "earlier");
  const last = Math.max(column, placeOf(scene.known, scene));
  if (scene.known < scene.end && last < width) drawUnknown(surface, scene, last, Math.min(width, placeOf(scene.end, scene)), "later");
  surface.line([column - 0.5, AXIS, column - 0.5, height], "line");
  drawAxis(surface, scene);
}

/** Draws again what depends on the playhead, on the drawing that is there: the axis, and the values beside the names of curves. */
export function drawPresent(surface, scene) {
  const { height, column, layout, scroll } = scene;
  surface.within(0, AXIS, column - SCALE, height - AXIS, () => {
    for (const row of layout.rows) {
      const y = row.y - scroll;
      if (!row.plot || y + row.height < AXIS || y > height) continue;
      surface.clear(0, y, column - SCALE, row.height - 1);
      drawPlotNames(surface, row, y, scene);
    }
  });
  drawAxis(surface, scene);
}

/** Draws the axis alone. Labels that the label of the playhead would cover are left out. */
function drawAxis(surface, scene) {
  const { width, height, column, now } = scene;
  const box = { x: column, y: AXIS, width: width - column, height: height - AXIS };
  surface.fill(0, 0, width, AXIS, "raised");
  drawTimes(surface, box, wholeSpan(scene), { y: 0, height: AXIS, lines: false, taken: now, longest: scene.end });
  surface.line([column - 0.5, 0, column - 0.5, AXIS], "line");
  surface.line([0, AXIS - 0.5, width, AXIS - 0.5], "line");
}

/** Covers a stretch of which the page has no events.
 *
 * @param {string} side Whether it is "earlier" or "later" than those that the page has. */
function drawUnknown(surface, scene, from, to, side) {
  surface.fill(from, AXIS, to - from, scene.height - AXIS, "line", 0.5);
  const text = cut(`${side} events are ${scene.fetching ? "being fetched …" : "not kept on this page"}`, to - from - 12);
  if (text) surface.text(text, ...(side === "earlier" ? [to - 4, scene.height - 10, "text", { anchor: "end" }] : [from + 8, scene.height - 10, "text"]));
}

function drawLane(surface, { lane, label, height }, y, scene) {
  const { column, width } = scene;
  surface.text(cutMiddle(label, column - 14), 8, y + height / 2, "text");
  surface.line([column, y + height - 0.5, width, y + height - 0.5], "raised");
  surface.within(column, y, width - column, height, () => drawBands(surface, lane.bands, y, height, scene));
}

function drawBands(surface, bands, y, height, scene) {
  const { column, width, span, end } = scene;
  const scale = secondsPerPixel(scene);
  const left = column + MARGIN - span.from / scale;
  const overAt = ({ from, to }) => to ?? Math.max(end, from); // the time at which a band is over
  const first = firstWhere(bands, (band) => band.to === null || band.to >= span.from);
  let last = column - 10; // the end of the last drawn band: of several in one pixel, one is enough
  let written = column; // the end of the last text of a mark
  let thin = null; // thin bands of one tone that touch are drawn as one: this is the tone
  let [begun, over] = [0, 0]; // where it begins and ends
  const drawThin = () => {
    if (thin) surface.fill(begun, y + 1.5, over - begun, height - 3, thin, 0.75);
    thin = null;
  };
  for (let n = first; n < bands.length && bands[n].from <= span.to; ) {
    const band = bands[n];
    const from = Math.max(column - 4, left + band.from / scale);
    const to = Math.min(width + 4, left + overAt(band) / scale);
    last = Math.max(to, from + 1);
    if (!band.mark && to - from <= THIN) {
      const tone = toneOf(band);
      if (thin !== tone || from > over + 0.7) {
        drawThin();
        thin = tone;
        begun = from;
      }
      over = last;
    } else {
      drawThin();
      if (band.mark) {
        const next = bands[n + 1] ? placeOf(bands[n + 1].from, scene) : width;
        written = drawMark(surface, band, from, { next, written, last: n === bands.length - 1, end: placeOf(end, scene) }, y, height);
      } else drawBand(surface, band, from, to, y, height);
    }
    if (last > width + 3.3) break;
    const seen = (last + 0.7 - left) * scale; // what is over before this time has no pixel of its own
    n = nextWhere(bands, (other) => overAt(other) >= seen, n + 1);
  }
  drawThin();
}

/** Returns the colour of a band: that of the curves about the same subject, if there are any. */
function toneOf({ subject, tone }) {
  return colourOf(subject) ?? tone;
}

function drawBand(surface, band, from, to, y, height) {
  const [wide, tone] = [to - from, toneOf(band)];
  surface.fill(from, y + 1.5, wide - 0.5, height - 3, tone, wide < 4 ? 0.75 : 0.26);
  if (wide >= 4) surface.fill(from, y + 1.5, 2, height - 3, tone);
  if (wide < ROOM) return;
  const text = cut(bandText(band), wide - 8, { mono: true });
  if (text) surface.text(text, from + 5, y + height / 2, "text", { mono: true });
}

/** Draws a mark with its text up to the next one; the text of the last one is on its left if there is more room, or if the playhead at the
 * newest moment would cross it on the right. Returns where it ends. */
function drawMark(surface, band, x, { next, written, last, end }, y, height) {
  const middle = y + height / 2;
  if (band.tick) surface.fill(x - 1, y + 1.5, 2, height - 3, toneOf(band));
  else surface.polygon([x, middle - 4, x + 4, middle, x, middle + 4, x - 4, middle], band.tone === "text" ? "quiet" : band.tone);
  const style = { mono: true };
  const [right, left] = [next - x - 14, last ? x - written - 18 : 0];
  const wide = last ? widthOf(bandText(band), style) : 0;
  const isCrossed = end > x + 7 && end < x + 7 + wide;
  const isLeft = (left > right && right < wide) || (isCrossed && left >= wide);
  const room = isLeft ? left : right;
  if (room < ROOM - 8) return x;
  const text = cut(bandText(band), room, style);
  if (text) surface.text(text, isLeft ? x - 7 : x + 7, middle, "text", isLeft ? { ...style, anchor: "end" } : style);
  return isLeft ? x : x + 7 + LETTER * text.length;
}

function drawPlotRow(surface, row, y, scene) {
  const { plot, height } = row;
  const { column, width } = scene;
  drawPlotNames(surface, row, y, scene);
  surface.line([0, y + height - 0.5, column, y + height - 0.5], "raised");
  drawCurves(surface, { x: column, y: y + 5, width: width - column, height: height - 9 }, { ...plot, span: wholeSpan(scene), until: scene.end });
}

/** Draws the heading of a plot, and the names of its curves, each with its value at the playhead if there is room. */
function drawPlotNames(surface, { plot, height }, y, scene) {
  const room = scene.column - SCALE - 8;
  surface.text(cutMiddle(headingOf(plot), room, { bold: true }), 8, y + 10, "text", { bold: true });
  const lines = Math.floor((height - PLOT) / NAME);
  const shown = plot.series.length > lines ? Math.max(0, lines - 1) : plot.series.length;
  const labels = labelsOf(plot, room - 12);
  plot.series.slice(0, shown).forEach((curve, n) => {
    const at = y + 25 + NAME * n;
    const value = numberText(presentValue(curve, scene));
    surface.line([8, at, 16, at], curve.colour, { width: 2, dash: curve.dash });
    surface.text(labels[n], 20, at, "quiet", SMALL);
    const isWide = widthOf(labels[n], SMALL) + BESIDE + widthOf(value, SMALL) <= room - 12; // otherwise the name has the room
    if (isWide) surface.text(value, scene.column - SCALE - 1, at, "text", { ...SMALL, anchor: "end" });
  });
  if (shown < plot.series.length) surface.text(`${shown > 0 ? "and " : ""}${plot.series.length - shown} more`, 20, y + 25 + NAME * shown, "quiet", SMALL);
}

/** Returns the value of a curve at the playhead; null if there is none. A line ends at the last tick, which may be before the playhead, and
 * while the run is active its newest values are not known yet: then the value is the last known one. */
function presentValue(curve, { present, end, running, period }) {
  if (present > end) return null;
  const last = curve.shape === "points" ? present : (curve.times.at(-1) ?? present);
  return valueAt(curve, running || present - last < period ? Math.min(present, last) : present);
}

/** Returns the labels of a plot's curves, at most `room` wide [px]: if one leaves no room for a value, without the words that all begin or end with. */
function labelsOf(plot, room) {
  const names = plot.series.map(({ name }) => shortName(name, plot));
  if (names.every((name) => widthOf(name, SMALL) <= room - BESIDE - VALUE)) return names;
  const words = names.map((name) => name.split(" "));
  const most = names.length > 1 ? Math.min(...words.map(({ length }) => length)) - 1 : Number(/^\S+: ./.test(names[0])); // of one curve, the name of its memory
  const isShared = (n) => words.every((list) => list.at(n) === words[0].at(n));
  let [first, last] = [0, 0];
  while (first < most && isShared(first)) first += 1;
  while (last < most - first && isShared(-1 - last)) last += 1;
  return words.map((list) => cutMiddle(list.slice(first, list.length - last).join(" "), room, SMALL));
}

/** Returns the name of a curve without redundant parts: the only body's name, and the plot's title. */
function shortName(name, { title, group, series }) {
  const of = chunkCurve(name);
  if (of) return title !== titleOf(group) ? of.part : `${of.memory}: ${of.chunk}${of.kind === "activation" ? "" : ` ${of.part}`}`;
  const [only = "", ...others] = Object.keys(bodies.peek());
  const body = others.length === 0 && /^[_ .]/.test(name.slice(only.length)) && name.startsWith(only) ? only : "";
  const rest = name.slice(body ? body.length + 1 : 0);
  const last = ` ${title}`;
  const short = rest.startsWith(title) ? rest.slice(title.length).trim() : rest.endsWith(last) ? rest.slice(0, -last.length) : rest.replace(`.${title}`, "");
  return short || (series.length === 1 && body) || rest;
}
