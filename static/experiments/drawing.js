// Draws a figure of means: an axis of levels, a scale, and lines of points with error bars.

import { cut, widthOf } from "../parts/surface.js";
import { seriesColour } from "../parts/curve.js";
import { roundRange, scaleText, stepFor, ticks } from "../parts/ticks.js";
import { valueText } from "../parts/chunk.js";

const LEFT = 52; // the width of the scale [px]
const RIGHT = 14;
const TOP = 8;
const AXIS = 34; // the height of the axis with its name [px]
const SIZE = 3.5; // the radius of a point [px]
const BETWEEN = 6; // the least distance between two labels [px]
const MAX_LABELS = 16;
const SAMPLE = 22; // the length of a line in the legend [px]
const ROW = 20; // the height of a row of the legend [px]
const SHAPES = [12, 4, 3, 5, 6, 7]; // corners: a circle, a square, a triangle …

/** Returns a value as a key that differs between 1, "1" and true. */
const keyOf = (value) => JSON.stringify(value);

/** Returns values in order: numbers by size, others as `known` lists them, and then by name. */
function inOrder(values, known = []) {
  const places = new Map(known.map((value, n) => [keyOf(value), n]));
  const place = (value) => places.get(keyOf(value)) ?? known.length;
  if (values.every((value) => typeof value === "number")) return values.toSorted((one, other) => one - other);
  return values.toSorted((one, other) => place(one) - place(other) || String(one).localeCompare(String(other)));
}

/** Returns the different values among some, in order. */
export function levelsOf(values, known) {
  return inOrder([...new Map(values.map((value) => [keyOf(value), value])).values()], known);
}

/**
 * Returns the geometry of a figure: {box, levels, range, xOf, yOf, marks}.
 *
 * @param lines [{points: [{at, mean, error}]}]
 * @param known The levels of the axis in the order of the design.
 */
export function layout(lines, known, width, height) {
  const box = { x: LEFT, y: TOP, width: Math.max(20, width - LEFT - RIGHT), height: Math.max(20, height - TOP - AXIS) };
  const points = lines.flatMap((line) => line.points);
  const levels = levelsOf(points.map(({ at }) => at[0]), known);
  const numeric = levels.length > 1 && levels.every((level) => typeof level === "number");
  const ends = points.flatMap(({ mean, error }) => [mean - (error ?? 0), mean + (error ?? 0)]);
  const range = points.length > 0 ? roundRange(Math.min(...ends), Math.max(...ends)) : [0, 1];
  const margin = numeric ? 14 : 0;
  const scale = numeric ? (box.width - 2 * margin) / (levels.at(-1) - levels[0]) : box.width / Math.max(1, levels.length);
  const places = new Map(levels.map((level, n) => [keyOf(level), numeric ? box.x + margin + (level - levels[0]) * scale : box.x + (n + 0.5) * scale]));
  const xOf = (level) => places.get(keyOf(level));
  const yOf = (value) => box.y + box.height - ((value - range[0]) / (range[1] - range[0])) * box.height;
  return { box, levels, range, xOf, yOf, room: numeric ? Infinity : scale - BETWEEN };
}

/** Returns the name of the colour of a line. */
const colourOf = (line) => line.colour ?? seriesColour(line.number);

/** Draws a figure; `name` is the name of the axis. */
export function drawFigure(surface, lines, { box, levels, range, xOf, yOf, room }, name) {
  const step = stepFor(range[1] - range[0], Math.max(2, Math.floor(box.height / 28)));
  for (const value of ticks(range[0], range[1], step)) {
    const y = Math.round(yOf(value)) + 0.5;
    surface.line([box.x, y, box.x + box.width, y], "line");
    surface.text(scaleText(value), box.x - 6, y, "quiet", { size: 10, anchor: "end" });
  }
  drawAxis(surface, box, levels, xOf, room);
  surface.text(cut(name, box.width), box.x + box.width / 2, box.y + box.height + 25, "quiet", { size: 11, anchor: "middle" });
  for (const line of lines) drawLine(surface, line, xOf, yOf);
}

function drawAxis(surface, box, levels, xOf, room) {
  const bottom = Math.round(box.y + box.height) + 0.5;
  surface.line([box.x, bottom, box.x + box.width, bottom], "strong-line");
  let taken = -Infinity;
  const every = Math.max(1, Math.ceil(levels.length / MAX_LABELS));
  levels.forEach((level, n) => {
    const x = xOf(level);
    surface.line([Math.round(x) + 0.5, bottom, Math.round(x) + 0.5, bottom + 3], "strong-line");
    const text = cut(valueText(level), Math.min(room, 120), { size: 10 });
    const half = widthOf(text, { size: 10 }) / 2;
    if (n % every || x - half < taken + BETWEEN) return;
    surface.text(text, x, bottom + 10, "quiet", { size: 10, anchor: "middle" });
    taken = x + half;
  });
}

function drawLine(surface, line, xOf, yOf) {
  const colour = colourOf(line);
  const dash = line.dashed ? [5, 3] : [];
  surface.line(line.points.flatMap(({ at, mean }) => [xOf(at[0]), yOf(mean)]), colour, { width: 1.5, dash });
  for (const { at, mean, error } of line.points) {
    const [x, y] = [xOf(at[0]), yOf(mean)];
    if (error) {
      const [upper, lower] = [yOf(mean + error), yOf(mean - error)];
      surface.line([x, upper, x, lower], colour, { width: 1 });
      for (const end of [upper, lower]) surface.line([x - 3, end, x + 3, end], colour, { width: 1 });
    }
    drawPoint(surface, x, y, line);
  }
}

/** Draws a sample of a line, 22 px wide, its middle at height y: its colour, dashes and mark. */
export function drawSample(surface, x, y, line) {
  surface.line([x, y, x + SAMPLE, y], colourOf(line), { width: 1.5, dash: line.dashed ? [5, 3] : [] });
  drawPoint(surface, x + SAMPLE / 2, y, line);
}

/** Returns the places of the entries of a legend, in as many rows as a width needs: {places: [{line, text, x, y}], height}. */
export function layoutLegend(lines, width) {
  const places = [];
  let [x, row] = [LEFT, 0];
  for (const line of lines) {
    const text = cut(line.name, width - LEFT - SAMPLE - 4);
    const length = SAMPLE + 4 + widthOf(text);
    if (x + length > width && x > LEFT) [x, row] = [LEFT, row + 1];
    places.push({ line, text, x, y: ROW * (row + 0.5) });
    x += length + 14;
  }
  return { places, height: lines.length > 0 ? ROW * (row + 1) : 0 };
}

export function drawLegend(surface, { places }) {
  for (const { line, text, x, y } of places) {
    drawSample(surface, x, y, line);
    surface.text(text, x + SAMPLE + 4, y, "text");
  }
}

/** Draws the mark of a line; that of a second experiment is hollow. */
function drawPoint(surface, x, y, line) {
  surface.polygon(corners(x, y, SIZE, line.number), colourOf(line));
  if (line.dashed) surface.polygon(corners(x, y, SIZE - 1.5, line.number), "panel");
}

function corners(x, y, radius, number) {
  const count = SHAPES[number % SHAPES.length];
  const turn = count === 4 ? Math.PI / 4 : -Math.PI / 2;
  const size = count === 12 ? radius : radius * 1.25;
  return Array.from({ length: count }, (_, n) => turn + (2 * Math.PI * n) / count).flatMap((angle) => [x + size * Math.cos(angle), y + size * Math.sin(angle)]);
}
