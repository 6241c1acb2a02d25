// Saves the timeline, or one of its plots, as PNG or SVG, and the values of curves as CSV.

import { html, signal } from "../vendor/preact.js";
import { csvText } from "../parts/csv.js";
import { dialog } from "../parts/dialog.js";
import { pictureName, runName, saveFile, savePicture } from "../parts/picture.js";
import { pictureOfPlot } from "../parts/plot.js";
import { session } from "../store.js";
import { headingOf, plots } from "./curves.js";
import { drawTimeline } from "./draw.js";
import { drawing } from "./canvas.js";
import { furthest } from "./seek.js";

const [WIDE, HIGH] = [900, 240]; // of a plot [px]
const which = signal("");

function ofTimeline() {
  const all = drawing(true);
  return { width: all.width, height: all.height, title: `Timeline: ${runName(session.peek())}`, draw: (surface) => drawTimeline(surface, all) };
}

function ofPlot(plot) {
  const { span, end } = drawing();
  return { ...pictureOfPlot({ ...plot, span, until: end }, WIDE, HIGH), title: `${headingOf(plot)}: ${runName(session.peek())}` };
}

/** Asks what to save, and saves it. */
export async function savePictures() {
  which.value = "";
  const offered = plots.peek();
  const body = html`<label class="field">
    Of what
    <select value=${which.value} onChange=${(event) => (which.value = event.currentTarget.value)}>
      <option value="">the timeline as shown; as CSV, all its curves</option>
      ${offered.map((plot, n) => html`<option key=${n} value=${n}>the plot of ${headingOf(plot)}</option>`)}
    </select>
  </label>`;
  const actions = [{ text: "SVG", value: "svg" }, { text: "PNG", value: "png", kind: "primary" }];
  if (offered.length > 0) actions.unshift({ text: "CSV", value: "csv" });
  const kind = await dialog({ title: "Save a picture or its values", body, actions });
  if (!kind) return;
  const plot = which.peek() === "" ? null : offered[Number(which.peek())];
  const name = pictureName(session.peek(), plot ? plot.title : "timeline");
  if (kind === "csv") saveFile(`${name}.csv`, new Blob([csvText((plot ? [plot] : offered).flatMap(({ series }) => series), furthest.peek())], { type: "text/csv" }));
  else savePicture({ ...(plot ? ofPlot(plot) : ofTimeline()), name }, kind);
}
