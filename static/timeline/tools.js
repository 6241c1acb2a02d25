// The tools above the timeline: visible rows, zoom, and where the run continues.

import { html } from "../vendor/preact.js";
import { bindKey } from "../keys.js";
import { dialog } from "../parts/dialog.js";
import { Icon } from "../parts/icon.js";
import { ManualLink } from "../parts/manual.js";
import { order } from "../server.js";
import { alive, running, session } from "../store.js";
import { CurveChoice } from "./choice.js";
import { names } from "./curves.js";
import { lanesVersion } from "./record.js";
import { groupsThere, hidden } from "./rows.js";
import { FEW } from "./pointer.js";
import { furthest, goTicks, inThePast, present, seek, wanted } from "./seek.js";
import { savePictures } from "./pictures.js";
import { filter } from "./canvas.js";
import { fit, mode, zoom } from "./view.js";

const STEP = 1.6; // the factor of a zoom button

function Groups() {
  lanesVersion.value;
  const there = groupsThere();
  const shows = (id) => !hidden.value.includes(id);
  const toggle = (id) => (hidden.value = shows(id) ? [...hidden.value, id] : hidden.value.filter((one) => one !== id));
  return html`<div class="timeline-groups" role="group" aria-label="Rows">
    ${there.map(({ id, text, title }) => html`<button key=${id} class="chip" aria-pressed=${shows(id)} title=${title} onClick=${() => toggle(id)}>${text}</button>`)}
  </div>`;
}

function near(factor) {
  zoom(factor, present.peek(), present.peek(), furthest.peek());
}

bindKey("Home", "To the beginning of the run", () => seek(0), "Timeline");
bindKey("End", "To its newest moment", () => seek(furthest.peek()), "Timeline");
bindKey("Shift+ArrowLeft", "Five ticks back", () => goTicks(-FEW), "Timeline");
bindKey("Shift+ArrowRight", "Five ticks on", () => goTicks(FEW), "Timeline");
bindKey("z", "Zoom in", () => near(1 / STEP), "Timeline");
bindKey("Shift+z", "Zoom out", () => near(STEP), "Timeline");
bindKey("f", "Show all of the run", fit, "Timeline");

function chooseCurves() {
  dialog({ title: "Curves below the lanes", body: html`<${CurveChoice} />` });
}

function Going() {
  const past = inThePast.value && !running.value;
  const ready = alive.value && past && wanted.value === null;
  return html`<div class="timeline-going">
    <button disabled=${!ready} title="Run on from this moment. It goes as it went before; if you change something here, another way begins." onClick=${() => order({ type: "run" })}>
      <${Icon} name="run" /><span>Continue from here</span>
    </button>
    <button disabled=${!alive.value || !past} title="Go to the newest moment of the run (End)" onClick=${() => seek(furthest.peek())}>
      <${Icon} name="until" /><span>Newest moment</span>
    </button>
  </div>`;
}

export function Tools() {
  return html`<div class="timeline-tools" role="toolbar" aria-label="Timeline">
    <h2>Timeline</h2>
    <${Groups} />
    <input type="search" aria-label="Filter rows" placeholder="Filter" value=${filter.value} onInput=${(event) => (filter.value = event.currentTarget.value)} />
    <button disabled=${names.value.length === 0} title="Choose the curves that are plotted" onClick=${chooseCurves}>Curves …</button>
    <span class="stretch"></span>
    <${Going} />
    <div class="timeline-zoom" role="group" aria-label="Zoom">
      <button class="bare" title="Show less, nearer (Z, wheel)" aria-label="Zoom in" onClick=${() => near(1 / STEP)}>+</button>
      <button class="bare" title="Show more (Shift Z, wheel)" aria-label="Zoom out" onClick=${() => near(STEP)}>−</button>
      <button class="bare" aria-pressed=${mode.value === "fit"} title="Show all of the run (F)" onClick=${fit}>Fit</button>
    </div>
    <button class="bare" disabled=${!session.value} title="Keep the timeline or a plot as a picture, or its values as CSV" aria-label="Keep a picture" onClick=${savePictures}><${Icon} name="download" /></button>
    <${ManualLink} page="timeline" title="Timeline" />
  </div>`;
}
