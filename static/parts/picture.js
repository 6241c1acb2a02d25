// Saved pictures: anything that draws on a surface, as PNG or SVG.

import { CanvasSurface, cut, SvgSurface } from "./surface.js";

export const SHARPNESS = 2; // pixels of a PNG per pixel of the page
const TITLE = 26; // height of the line above a picture [px]
const MARGIN = 12; // [px]

/**
 * @typedef Picture
 * @property {string} name The file's name, without its ending.
 * @property {string} title What it shows, and of which run; drawn above it.
 * @property {number} width [px]
 * @property {number} height [px]
 * @property {(surface) => void} draw Draws it, from 0, 0.
 */

const hasSeed = (seed) => seed !== null && seed !== undefined;

/** Returns the name of a picture's file, without its ending: of which run, and what. */
export function pictureName({ model, seed }, what) {
  return `${model.replace(/\.py$/, "")}${hasSeed(seed) ? ` seed ${seed}` : ""} ${what}`;
}

/** Returns a description of a run for the line above a picture. */
export function runName({ model, run, seed }) {
  return `${model}, run ${run}${hasSeed(seed) ? `, seed ${seed}` : ""}`;
}

/** Draws a picture with its title and background. */
function drawWhole(surface, { title, width, height, draw }) {
  surface.fill(0, 0, width + 2 * MARGIN, height + TITLE + 2 * MARGIN, "panel");
  const style = { size: 12, bold: true };
  surface.text(cut(title, width, style), MARGIN, MARGIN + TITLE / 2 - 4, "text", style);
  surface.at(MARGIN, MARGIN + TITLE, () => draw(surface));
}

function sizeOf({ width, height }) {
  return [Math.ceil(width + 2 * MARGIN), Math.ceil(height + TITLE + 2 * MARGIN)];
}

/** Returns a picture as the text of an SVG file. */
function svgText(picture) {
  const surface = new SvgSurface(...sizeOf(picture));
  drawWhole(surface, picture);
  return `<?xml version="1.0" encoding="UTF-8"?>\n${new XMLSerializer().serializeToString(surface.root)}\n`;
}

/** Returns a picture as a PNG. */
function pngBlob(picture) {
  const canvas = document.createElement("canvas");
  const [width, height] = sizeOf(picture);
  // No browser makes a canvas of more than 16,384 pixels a side.
  const scale = Math.min(SHARPNESS, 16_000 / Math.max(width, height));
  canvas.width = width * scale;
  canvas.height = height * scale;
  const context = canvas.getContext("2d");
  context.scale(scale, scale);
  drawWhole(new CanvasSurface(context), picture);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** Saves a picture as a file: `kind` is "png" or "svg". */
export async function savePicture(picture, kind) {
  const blob = kind === "svg" ? new Blob([svgText(picture)], { type: "image/svg+xml" }) : await pngBlob(picture);
  saveFile(`${picture.name}.${kind}`, blob);
}

/** Downloads a file to the user's computer. */
export function saveFile(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name.replace(/[^\p{L}\p{M}\p{N}_.+-]+/gu, "_");
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
