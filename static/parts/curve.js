// Draws curves over time in a box: a scale at the left, lines at round values, each curve in its own colour.

import { digitsOf, roundRange, scaleText, stepFor, ticks, timeStep } from "./ticks.js";
import { firstFrom } from "./search.js";
import { cut, widthOf } from "./surface.js";
import { timeText } from "./units.js";

export const COLOUR_COUNT = 6;
const MIN_RANGE = 0.01; // smaller differences are drawn as a straight line, not as amplified numerical noise
const BETWEEN = 4; // the minimum distance between two labels of an axis [px]
const SAME = 1e-6; // times that are no farther apart are the same [s]
const FEW = 4; // up to this number, all values of a pixel are drawn; of more, the first, the least, the greatest and the last one
const GROUP = 16; // the number of values whose least and greatest ones are kept
const HIDDEN = 0.5; // up to this distance, a curve hides another one [px]
const GAP = 6; // the length of the gaps and dashes of a line that lies on another one [px]
const EDGES = 2; // how far what is at the least or greatest value is drawn beyond the box [px]
const EDGE = 6; // the distance of the first and last text from the ends of an axis [px]

/** Returns the name of the colour of the nth curve. */
export function seriesColour(n) {
  return `series-${(n % COLOUR_COUNT) + 1}`;
}

/**
 * Returns the value of a curve at a time [s], as `drawCurves` draws it: null where no line is drawn.
 *
 * @param near The distance up to which a moment counts that no line leads to [s].
 */
export function valueAt({ times, values, shape = "line", slope, until = Infinity }, time, near = 0) {
  const at = firstFrom(times, time + SAME) - 1;
  const [before, after] = [values[at] ?? null, values[at + 1] ?? null];
  const since = time - times[at];
  if (before !== null) {
    if (since <= SAME) return before;
    if (slope !== undefined && at === times.length - 1) return time <= until + SAME ? before + slope * since : null;
    if (shape === "steps" && at < times.length - 1) return before;
    if (after !== null && shape !== "points") return before + ((after - before) * since) / (times[at + 1] - times[at]);
    if (since <= near) return before;
  }
  return after !== null && times[at + 1] - time <= near ? after : null;
}

/** Returns a round range that contains the values of some curves. */
export function rangeOf(series) {
  let [least, most] = [Infinity, -Infinity];
  for (const { values, range } of series) {
    const [low, high] = range ?? leastAndMost(values);
    [least, most] = [Math.min(least, low), Math.max(most, high)];
  }
  if (Math.max(Math.abs(least), Math.abs(most)) < MIN_RANGE / 2) return [0, 1]; // nothing has moved yet
  const room = Math.max(0, MIN_RANGE - (most - least)) / 2;
  return roundRange(least - room, most + room);
}

const groups = new WeakMap(); // by values

/** Returns the numbers of the least and the greatest value of each group of values, {count, least, most}; -1 where all are missing. Only
 * those of new values are computed. */
function groupsOf(values) {
  if (!groups.has(values)) groups.set(values, { count: 0, least: [], most: [] });
  const known = groups.get(values);
  if (known.count > values.length) known.count = 0;
  if (known.count === values.length) return known;
  for (let group = Math.floor(known.count / GROUP); group * GROUP < values.length; group += 1) {
    [known.least[group], known.most[group]] = extremesAmong(values, group * GROUP, Math.min((group + 1) * GROUP, values.length));
  }
  known.count = values.length;
  return known;
}

/** Replaces some of a curve's times or values, in place: of many, those before them cost nothing. */
export function replace(list, first, beyond, news) {
  list.splice(first, beyond - first, ...news);
  const known = groups.get(list);
  if (known) known.count = Math.min(known.count, first);
}

/** Returns the least and the greatest of a curve's values; [Infinity, -Infinity] if all are missing. */
export function leastAndMost(values) {
  const [least, most] = extremesOf(values, 0, values.length);
  return least < 0 ? [Infinity, -Infinity] : [values[least], values[most]];
}

/** Returns the numbers of the least and the greatest of some values, [-1, -1] if all are missing. `known` are those of another part. */
function extremesAmong(values, first, beyond, known = [-1, -1]) {
  let [least, most] = known;
  for (let n = first; n < beyond; n += 1) {
    const value = values[n];
    if (value === null || value === undefined || Number.isNaN(value)) continue;
    if (least < 0 || value < values[least]) least = n;
    if (most < 0 || value > values[most]) most = n;
  }
  return [least, most];
}

/** The same for any number of values. */
function extremesOf(values, first, beyond) {
  const [begin, end] = [Math.ceil(first / GROUP), Math.floor(beyond / GROUP)];
  if (end <= begin) return extremesAmong(values, first, beyond);
  const known = groupsOf(values);
  let [least, most] = extremesAmong(values, first, begin * GROUP);
  for (let group = begin; group < end; group += 1) {
    const [low, high] = [known.least[group], known.most[group]];
    if (low < 0) continue;
    if (least < 0 || values[low] < values[least]) least = low;
    if (most < 0 || values[high] > values[most]) most = high;
  }
  return extremesAmong(values, end * GROUP, beyond, [least, most]);
}

/** Calls `draw(first, beyond)` with the numbers of the values of each pixel that has any, and of one value more at each end. */
function byPixel({ times }, span, box, draw) {
  const [begin, end] = [firstFrom(times, span.from), firstFrom(times, span.to)];
  const pixel = (span.to - span.from) / box.width;
  if (begin > 0) draw(begin - 1, begin);
  for (let first = begin; first < end; ) {
    const over = span.from + (Math.floor((times[first] - span.from) / pixel) + 1) * pixel;
    let beyond = first + 1;
    if (beyond < end && times[beyond] < over) beyond = Math.min(end, firstFrom(times, over, beyond));
    draw(first, beyond);
    first = beyond;
  }
  if (end < times.length) draw(end, end + 1);
}

/** Returns a curve as points in a box; of many values that share a pixel, only those that make a difference. */
function pointsOf(curve, span, box, yOf) {
  const { times, values, shape, slope, until } = curve;
  const scale = box.width / (span.to - span.from);
  const points = [];
  const xOf = (n) => box.x + (times[n] - span.from) * scale;
  const add = (n) => points.push(xOf(n), (values[n] ?? null) === null ? NaN : yOf(values[n]));
  byPixel(curve, span, box, (first, beyond) => {
    if (shape === "steps" && points.length > 0) points.push(xOf(first), points.at(-1));
    if (beyond - first <= FEW) {
      for (let n = first; n < beyond; n += 1) {
        if (shape === "steps" && n > first) points.push(xOf(n), points.at(-1));
        add(n);
      }
      return;
    }
    const [least, most] = extremesOf(values, first, beyond);
    add(first);
    if (least >= 0) {
      add(Math.min(least, most));
      add(Math.max(least, most));
    }
    add(beyond - 1);
  });
  const end = times.length - 1;
  if (slope !== undefined && end >= 0 && values[end] !== null && until > times[end]) {
    points.push(box.x + (until - span.from) * scale, yOf(values[end] + slope * (until - times[end])));
  }
  return points;
}

/** Returns the values of single moments as strokes in a box, [x, top, bottom, …]; those that share a pixel are one stroke. */
function strokesOf(curve, span, box, yOf) {
  const { times, values } = curve;
  const scale = box.width / (span.to - span.from);
  const strokes = [];
  byPixel(curve, span, box, (first, beyond) => {
    const [least, most] = extremesOf(values, first, beyond);
    if (least >= 0) strokes.push(box.x + (times[Math.min(least, most)] - span.from) * scale, yOf(values[most]), yOf(values[least]));
  });
  return strokes;
}

/** Returns whether a curve would hide another one: whether all of their places, as numbers, are nearly the same. */
function hides(places, others) {
  const isSame = (one, n) => Math.abs(one - others[n]) < HIDDEN || Object.is(one, others[n]);
  return places.length === others.length && places.every(isSame);
}

/** Returns the dashes of a line that lies on some others, with gaps in which each of them is seen. */
function dashesOver(count, dash) {
  if (count === 0) return dash ?? [];
  const own = dash ?? [GAP, 0];
  return own.with(-1, own.at(-1) + count * own.reduce((sum, length) => sum + length));
}

/** Returns the values labelled on a scale: at least two, because one alone shows no size; otherwise as many as fit. */
function scaleOf(least, most, room) {
  const values = ticks(least, most, stepFor(most - least, room));
  return values.length > 1 ? values : ticks(least, most, stepFor(most - least, room + 1));
}

/** Yields the points [x, y] of [x, y, x, y, …] that no line would show: those between two breaks. */
function* alone(points) {
  const broken = (n) => n < 0 || n >= points.length || Number.isNaN(points[n + 1]);
  for (let n = 0; n < points.length; n += 2) if (!broken(n) && broken(n - 2) && broken(n + 2)) yield [points[n], points[n + 1]];
}

/**
 * Draws curves. A line that lies on others is wider and has gaps; moments that lie on others are drawn beside them.
 *
 * @param surface The surface to draw on.
 * @param box {x, y, width, height} of the curves; the scale is left of it.
 * @param series [{name, unit, times, values, colour?, dash?, shape?, slope?, until?}]: of the shape "points", each value is that of a
 *   moment; of "steps", it holds until the next one; of any other, a line joins them. With `slope`, the last value goes on until `until`,
 *   and changes by it in a second.
 * @param span {from, to}: the times from the left to the right edge [s].
 * @param range [least, most]: the values from the lower to the upper edge.
 * @param until The end of curves that go on, and have no `until` of their own [s].
 */
export function drawCurves(surface, box, { series, span, range, until }) {
  const [least, most] = range;
  const yOf = (value) => box.y + box.height - ((value - least) / (most - least)) * box.height;
  for (const value of scaleOf(least, most, Math.max(1, Math.floor(box.height / 11)))) {
    const y = Math.round(yOf(value)) + 0.5;
    surface.line([box.x, y, box.x + box.width, y], "line");
    if (y > box.y + 4) surface.text(scaleText(value), box.x - 5, y, "quiet", { size: 10, anchor: "end" });
  }
  surface.within(box.x, box.y - EDGES, box.width, box.height + 2 * EDGES, () => {
    const drawn = { lines: [], strokes: [] };
    series.forEach(({ colour, dash, ...curve }, n) => {
      const [of, name] = [{ until, ...curve }, colour ?? seriesColour(n)];
      const [kind, places] = of.shape === "points" ? ["strokes", strokesOf(of, span, box, yOf)] : ["lines", pointsOf(of, span, box, yOf)];
      const below = drawn[kind].filter((others) => hides(places, others)).length;
      drawn[kind].push(places);
      if (kind === "lines") {
        surface.line(places, name, { width: 1.5 * (1 + below), dash: dashesOver(below, dash) });
        for (const [x, y] of alone(places)) surface.fill(x - 2 + 4 * below, y - 2, 4, 4, name);
      } else {
        for (let at = 0; at < places.length; at += 3) {
          const [x, top, bottom] = places.slice(at, at + 3);
          surface.fill(x - 1.5 + 3 * below, top - 1.5, 3, bottom - top + 3, name);
        }
      }
    });
  });
}

/** Draws an axis of time with its lines; returns the step between them [s]. `box` is the position of the drawing it belongs to; its labels
 * stay within the range `room`, and those that would touch the range `taken` are left out [px]. */
export function drawTimes(surface, box, span, { y, height = 18, lines = true, room = { from: box.x, to: box.x + box.width }, taken = null, longest = span.to } = {}) {
  const step = timeStep(span, Math.max(2, Math.floor(box.width / 80)));
  const scale = box.width / (span.to - span.from);
  for (const time of ticks(span.from, span.to, step)) {
    const x = Math.round(box.x + (time - span.from) * scale) + 0.5;
    if (lines) surface.line([x, box.y, x, box.y + box.height], "line");
    const text = timeText(time, digitsOf(step), longest);
    const half = widthOf(text, { size: 10 }) / 2;
    const at = Math.min(Math.max(x, room.from + EDGE + half), room.to - EDGE - half);
    if (taken && at + half > taken.from - BETWEEN && at - half < taken.to + BETWEEN) continue;
    surface.text(text, at, y + height / 2, "quiet", { size: 10, anchor: "middle" });
  }
  return step;
}

/** Draws the names of the curves, from x on, as far as there is room. */
export function drawLegend(surface, x, y, width, series) {
  let at = x;
  series.forEach(({ name, colour, dash }, n) => {
    const text = cut(name, Math.max(0, x + width - at - 24));
    if (!text) return;
    surface.line([at, y, at + 12, y], colour ?? seriesColour(n), { width: 2, dash: dash ?? [] });
    surface.text(text, at + 16, y, "text");
    at += 30 + widthOf(text);
  });
}
