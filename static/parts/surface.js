// Drawing surfaces: a canvas, or an SVG to save. Both have the same methods, so that a saved picture looks like the page.

import { colour } from "../theme.js";

const measure = document.createElement("canvas").getContext("2d");
const MAX_WIDTHS = 5000;
const widths = new Map();

/** Returns a font in CSS syntax. */
function fontOf({ mono = false, size = 11, bold = false }) {
  return `${bold ? "600 " : ""}${size}px ${colour(mono ? "mono" : "sans")}`;
}

/** Returns the width of a text [px]. */
export function widthOf(text, style = {}) {
  const key = `${style.mono ? "m" : "s"}${style.size ?? 11}${style.bold ? "b" : ""}${text}`;
  let width = widths.get(key);
  if (width === undefined) {
    measure.font = fontOf(style);
    width = measure.measureText(text).width;
    if (widths.size > MAX_WIDTHS) widths.clear();
    widths.set(key, width);
  }
  return width;
}

/** Returns the lines of a text that is broken between words, none of which is wider than a width, unless a word is. */
export function wrapped(text, most) {
  const lines = [];
  for (const word of text.split(" ")) {
    const longer = `${lines.at(-1)} ${word}`;
    if (lines.length > 0 && widthOf(longer) <= most) lines[lines.length - 1] = longer;
    else lines.push(word);
  }
  return lines;
}

/** Returns as much of a text as fits, with an ellipsis if it is cut. */
export function cut(text, most, style = {}) {
  const line = text.length > 400 ? text.slice(0, 400) : text;
  if (widthOf(line, style) <= most) return line;
  return longestFit(line.length, (kept) => `${line.slice(0, kept)}…`, most, style);
}

/** Returns a name that fits into a width [px]; a longer one has an ellipsis in its middle: names differ at their beginnings and ends. */
export function cutMiddle(name, most, style = {}) {
  if (widthOf(name, style) <= most) return name;
  const letters = Array.from(name);
  const shortened = (kept) => `${letters.slice(0, Math.ceil(kept / 2)).join("")}…${letters.slice(letters.length - Math.floor(kept / 2)).join("")}`;
  return longestFit(letters.length, shortened, most, style);
}

/** Returns the longest shortened text that fits: `shortened` makes one of a number of letters, less than `count`; "" if none fits. */
function longestFit(count, shortened, most, style) {
  let [fits, over] = [0, count];
  while (over - fits > 1) {
    const kept = (fits + over) >> 1;
    if (widthOf(shortened(kept), style) <= most) fits = kept;
    else over = kept;
  }
  return fits > 0 ? shortened(fits) : "";
}

/** Calls `go` with each point of [x, y, x, y, …] and whether a line begins there; NaN breaks it. */
function along(points, go) {
  let begins = true;
  for (let n = 0; n < points.length; n += 2) {
    const isBreak = Number.isNaN(points[n + 1]);
    if (!isBreak) go(points[n], points[n + 1], begins);
    begins = isBreak;
  }
}

/** Draws on a canvas. Colours are names of style.css. */
export class CanvasSurface {
  constructor(context) {
    this.context = context;
    this.colours = new Map();
    this.fonts = new Map();
  }

  #colour(name) {
    if (!this.colours.has(name)) this.colours.set(name, colour(name));
    return this.colours.get(name);
  }

  #font(style) {
    const key = `${style.mono}${style.size}${style.bold}`;
    if (!this.fonts.has(key)) this.fonts.set(key, fontOf(style));
    return this.fonts.get(key);
  }

  fill(x, y, width, height, name, alpha = 1) {
    const { context } = this;
    context.globalAlpha = alpha;
    context.fillStyle = this.#colour(name);
    context.fillRect(x, y, width, height);
    context.globalAlpha = 1;
  }

  clear(x, y, width, height) {
    this.context.clearRect(x, y, width, height);
  }

  /** A line through [x, y, x, y, …]; NaN breaks it. */
  line(points, name, { width = 1, dash = [], alpha = 1 } = {}) {
    const { context } = this;
    context.globalAlpha = alpha;
    context.strokeStyle = this.#colour(name);
    context.lineWidth = width;
    context.lineJoin = "round";
    context.setLineDash(dash);
    context.beginPath();
    along(points, (x, y, begins) => (begins ? context.moveTo(x, y) : context.lineTo(x, y)));
    context.stroke();
    context.globalAlpha = 1;
  }

  polygon(points, name) {
    const { context } = this;
    context.fillStyle = this.#colour(name);
    context.beginPath();
    for (let n = 0; n < points.length; n += 2) context.lineTo(points[n], points[n + 1]);
    context.fill();
  }

  /** Draws a text whose middle is at height y; `anchor` is start, middle or end. */
  text(text, x, y, name, style = {}) {
    const { context } = this;
    context.font = this.#font(style);
    context.fillStyle = this.#colour(name);
    context.textBaseline = "middle";
    context.textAlign = { start: "left", middle: "center", end: "right" }[style.anchor ?? "start"];
    context.fillText(text, x, y);
  }

  /** Draws with the origin moved to a place. */
  at(x, y, draw) {
    const { context } = this;
    context.save();
    context.translate(x, y);
    draw();
    context.restore();
  }

  /** Draws with clipping to a rectangle. */
  within(x, y, width, height, draw) {
    const { context } = this;
    context.save();
    context.beginPath();
    context.rect(x, y, width, height);
    context.clip();
    draw();
    context.restore();
  }
}

/** Creates a self-contained SVG. Colours are names of style.css. */
export class SvgSurface {
  constructor(width, height) {
    this.root = node("svg", { width, height, viewBox: `0 0 ${width} ${height}` });
    this.into = this.root;
    this.clips = 0;
  }

  fill(x, y, width, height, name, alpha = 1) {
    this.into.append(node("rect", { x: short(x), y: short(y), width: short(width), height: short(height), fill: colour(name), ...(alpha < 1 ? { "fill-opacity": alpha } : {}) }));
  }

  line(points, name, { width = 1, dash = [], alpha = 1 } = {}) {
    let path = "";
    along(points, (x, y, begins) => (path += `${begins ? "M" : "L"}${short(x)} ${short(y)}`));
    const dashes = { ...(dash.length ? { "stroke-dasharray": dash.join(" ") } : {}), ...(alpha < 1 ? { "stroke-opacity": alpha } : {}) };
    this.into.append(node("path", { d: path, fill: "none", stroke: colour(name), "stroke-width": width, "stroke-linejoin": "round", ...dashes }));
  }

  polygon(points, name) {
    this.into.append(node("polygon", { points: Array.from(points, short).join(" "), fill: colour(name) }));
  }

  text(text, x, y, name, style = {}) {
    const bold = style.bold ? { "font-weight": 600 } : {};
    const font = { "font-family": colour(style.mono ? "mono" : "sans"), "font-size": style.size ?? 11, ...bold };
    const made = node("text", { x: short(x), y: short(y), fill: colour(name), "text-anchor": style.anchor ?? "start", "dominant-baseline": "central", ...font });
    made.textContent = text;
    this.into.append(made);
  }

  at(x, y, draw) {
    this.#group({ transform: `translate(${x} ${y})` }, draw);
  }

  within(x, y, width, height, draw) {
    this.clips += 1;
    const clip = node("clipPath", { id: `clip${this.clips}` });
    clip.append(node("rect", { x, y, width, height }));
    this.into.append(clip);
    this.#group({ "clip-path": `url(#clip${this.clips})` }, draw);
  }

  #group(attributes, draw) {
    const outer = this.into;
    this.into = node("g", attributes);
    outer.append(this.into);
    draw();
    this.into = outer;
  }
}

const SVG = "http://www.w3.org/2000/svg";
const short = (number) => String(Math.round(number * 100) / 100);

function node(name, attributes) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
}

/** Sets a canvas's resolution to the screen's for a size [CSS px], and clears it; returns its context, in CSS pixels. */
export function scaled(canvas, width, height) {
  const scale = devicePixelRatio || 1;
  const [wide, high] = [Math.round(width * scale), Math.round(height * scale)];
  if (canvas.width !== wide || canvas.height !== high) Object.assign(canvas, { width: wide, height: high });
  const context = canvas.getContext("2d");
  context.setTransform(scale, 0, 0, scale, 0, 0);
  context.clearRect(0, 0, width, height);
  return context;
}
