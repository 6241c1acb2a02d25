// Saves the timeline, or one of its plots, as PNG or SVG.

import { html, signal } from "../vendor/preact.js";
import { drawCurves, drawLegend, drawTimes } from "../parts/curve.js";
import { dialog } from "../parts/dialog.js";
import { savePicture } from "../parts/picture.js";
import { session } from "../store.js";
import { plots } from "./curves.js";
import { drawTimeline } from "./draw.js";
import { scene } from "./canvas.js";

const [WIDE, HIGH, LEFT] = [900, 260, 46]; // of a plot [px]
const which = signal("");

/** Returns a description of the run. */
function runText() {
  const { model, run, seed } = session.peek();
  return `${model}, run ${run}${seed === null || seed === undefined ? "" : `, seed ${seed}`}`;
}

function ofTimeline() {
  const all = scene(true);
  return { width: all.width, height: all.height, title: `Timeline: ${runText()}`, draw: (surface) => drawTimeline(surface, all) };
}

function ofPlot(plot) {
  const { span } = scene();
  const box = { x: LEFT, y: 22, width: WIDE - LEFT - 8, height: HIGH - 42 };
  const draw = (surface) => {
    drawLegend(surface, LEFT, 8, WIDE - LEFT, plot.series);
    drawTimes(surface, box, span, { y: box.y + box.height });
    drawCurves(surface, box, { ...plot, span });
  };
  return { width: WIDE, height: HIGH, title: `${plot.title} [${plot.unit}]: ${runText()}`, draw };
}

/** Asks what to save, and saves it. */
export async function savePictures() {
  which.value = "";
  const body = html`<label class="field">
    Of what
    <select value=${which.value} onChange=${(event) => (which.value = event.currentTarget.value)}>
      <option value="">the timeline: all rows that are shown, from edge to edge</option>
      ${plots.peek().map(({ title, unit }) => html`<option value="${title} [${unit}]">the plot of ${title} [${unit}]</option>`)}
    </select>
  </label>`;
  const kind = await dialog({
    title: "Keep a picture",
    body,
    actions: [{ text: "Cancel", value: null }, { text: "SVG", value: "svg" }, { text: "PNG", value: "png", kind: "primary" }],
  });
  if (!kind) return;
  const plot = plots.peek().find(({ title, unit }) => `${title} [${unit}]` === which.peek());
  const picture = plot ? ofPlot(plot) : ofTimeline();
  const { model, seed } = session.peek();
  const name = [model.replace(/\.py$/, ""), `seed ${seed}`, plot ? plot.title : "timeline"].join(" ");
  savePicture({ ...picture, name }, kind);
}
