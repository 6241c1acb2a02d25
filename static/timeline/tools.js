// The tools above the timeline: visible rows, zoom, and where the run continues.

import { html } from "../vendor/preact.js";
import { command, commandsOf, run } from "../commands.js";
import { buttonTitle } from "../keys.js";
import { AreaMenu } from "../parts/area_menu.js";
import { Button } from "../parts/button.js";
import { dialog } from "../parts/dialog.js";
import { Icon } from "../parts/icon.js";
import { ManualLink } from "../parts/manual.js";
import { toggled } from "../parts/toggled.js";
import { lastEvent, runStatus } from "../run_status.js";
import { sendCommand } from "../server.js";
import { alive, hasScene, running, session } from "../store.js";
import { reach } from "./branches.js";
import { CurveChoice } from "./choice.js";
import { chosen as plotted, names, plot } from "./curves.js";
import { lanesVersion } from "./record.js";
import { filter, groupsThere, grow, hidden } from "./rows.js";
import { FEW } from "./pointer.js";
import { furthest, goTicks, inThePast, present, seek, wanted } from "./seek.js";
import { savePictures } from "./pictures.js";
import { fitTo, mode, zoom } from "./view.js";
import { openWindow } from "../windows.js";

const STEP = 1.6; // the factor of a zoom button

function Groups() {
  lanesVersion.value;
  const there = groupsThere();
  return html`<div class="timeline-groups" role="group" aria-label="Rows">
    ${there.map(({ id, text, title }) => html`<button key=${id} class="chip" aria-pressed=${!hidden.value.includes(id)} title=${title} onClick=${() => (hidden.value = toggled(hidden.value, id))}>${text}</button>`)}
  </div>`;
}

function near(factor) {
  zoom(factor, present.peek(), present.peek(), reach.peek());
}

/** Shows the run up to its last event: it may go on without any. A body moves on, and branches have events of their own. */
function fit() {
  const isAll = hasScene.peek() || running.peek() || reach.peek() > furthest.peek();
  fitTo((!isAll && lastEvent()) || reach.peek(), reach.peek());
}

/** Registers a command of the timeline. */
function registered(text, key, work, ready, why = () => runStatus.value.text) {
  return command({ text, key, group: "Timeline", work, ready, why });
}

const noCurves = () => (session.value ? "This run has no curves yet." : runStatus.value.text);

const canGo = () => alive.value;
registered("To the beginning of the run", "Home", () => seek(0), canGo);
const toNewest = registered("To its newest moment", "End", () => seek(furthest.peek()), canGo);
registered("Five ticks back", "Shift+ArrowLeft", () => goTicks(-FEW), canGo);
registered("Five ticks forward", "Shift+ArrowRight", () => goTicks(FEW), canGo);
const zoomIn = registered("Zoom in", "z", () => near(1 / STEP));
const zoomOut = registered("Zoom out", "Shift+z", () => near(STEP));
registered("Make the plots taller", "h", () => grow(1), () => names.value.length > 0, noCurves);
registered("Make the plots shorter", "Shift+h", () => grow(-1), () => names.value.length > 0, noCurves);
const showAll = registered("Fit to what happened in the run; again: to all of it", "f", fit);
const curves = registered("Choose the curves that are plotted", null, chooseCurves, () => names.value.length > 0 || running.value, noCurves);
const keep = command({
  text: "Save the timeline or a plot as a picture, or its values as CSV",
  also: "export download PNG SVG figure",
  group: "Timeline",
  work: savePictures,
  ready: () => Boolean(session.value),
  why: () => runStatus.value.text,
});
const openTimeline = command({ text: "Open the timeline in a window of its own", group: "Page", work: () => openWindow("timeline") });
commandsOf(() => names.value.map(({ name }) => {
  const shown = plotted.value.includes(name);
  return { text: `${shown ? "Remove the curve" : "Plot the curve"} ${name}`, group: "Timeline", work: () => plot(name, !shown) };
}));

function chooseCurves() {
  dialog({ title: "Curves below the lanes", body: html`<${CurveChoice} />` });
}

function Going() {
  const past = inThePast.value && !running.value;
  const ready = alive.value && past && wanted.value === null;
  return html`<div class="timeline-going">
    <${Button} disabled=${!ready} title="Run from this moment. It repeats what happened; a change here begins a branch." onClick=${() => sendCommand({ type: "run" })}>
      <${Icon} name="run" /><span>Continue from here</span>
    <//>
    <${Button} disabled=${!alive.value || !past} title=${buttonTitle(toNewest, "Go to the newest moment of the run")} onClick=${() => run(toNewest)}>
      <${Icon} name="until" /><span>Newest moment</span>
    <//>
  </div>`;
}

export function Tools() {
  return html`<div class="timeline-tools" role="toolbar" aria-label="Timeline">
    <h2>Timeline</h2>
    <${Groups} />
    <input type="search" aria-label="Filter rows" placeholder="Filter" value=${filter.value} onInput=${(event) => (filter.value = event.currentTarget.value)} />
    <${Button} disabled=${!curves.ready()} title=${buttonTitle(curves)} onClick=${chooseCurves}>Curves …<//>
    <span class="stretch"></span>
    <${Going} />
    <div class="timeline-zoom" role="group" aria-label="Zoom">
      <button class="bare" title=${buttonTitle(zoomIn, "Show less, nearer; also the wheel")} aria-label="Zoom in" onClick=${zoomIn.work}>+</button>
      <button class="bare" title=${buttonTitle(zoomOut, "Show more; also the wheel")} aria-label="Zoom out" onClick=${zoomOut.work}>−</button>
      <button class="bare" aria-pressed=${mode.value === "fit"} title=${buttonTitle(showAll)} onClick=${fit}>Fit</button>
    </div>
    <${Button} class="bare" disabled=${!keep.ready()} title=${buttonTitle(keep)} aria-label="Save a picture" onClick=${savePictures}><${Icon} name="download" /><//>
    <${ManualLink} page="timeline" title="Timeline" />
    <${AreaMenu} area="timeline" opening=${openTimeline} />
  </div>`;
}
