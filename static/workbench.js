// The layout: the top bar, the 3D view beside the tabs, the timeline below, and the status line; or, in a window of its own, one panel.

import { html, useEffect } from "./vendor/preact.js";
import { alone, embedded } from "./address.js";
import { Bar } from "./bar/bar.js";
import { Clock } from "./bar/clock.js";
import { begin, listModels } from "./bar/models.js";
import { RecordingBanner } from "./bar/recording_banner.js";
import { StatusLine } from "./bar/status.js";
import { Transport } from "./bar/transport.js";
import "./changes/undo.js";
import { command, run } from "./commands.js";
import { Comparison } from "./compare/compare.js";
import { noteKey } from "./keys.js";
import { isAvailable } from "./needs.js";
import { AREAS, hasWorld, isCollapsed, layoutCommands, maximised, panelsWidth, swapped, timelineHeight } from "./layout.js";
import { goToTab, openTab } from "./open_tab.js";
import { CommandPalette } from "./palette/palette.js";
import { PANELS } from "./panels.js"; // made by the server: all files of panels/ that export a panel
import { AreaMenu } from "./parts/area_menu.js";
import { Dialogs } from "./parts/dialog.js";
import { Icon } from "./parts/icon.js";
import "./parts/second_click.js";
import { Splitter } from "./parts/splitter.js";
import { Tabs } from "./parts/tabs.js";
import { Toasts } from "./parts/toasts.js";
import { Scene } from "./panels/scene.js";
import { Timeline } from "./panels/timeline.js";
import { hurried, notify, session } from "./store.js";
import { show } from "./server.js";
import { silent } from "./silence.js";
import { follow, openWindow } from "./windows.js";

const MIN_SCENE = 320; // [px]
/** What a window can show alone. */
const VIEWS = { ...Object.fromEntries(PANELS.map(({ id, title, View }) => [id, { title, View }])), scene: { title: "3D view", View: Scene }, timeline: { title: "Timeline", View: Timeline } };

const TABS = PANELS.filter(({ needs = null }) => isAvailable(needs));

const SILENT = `The ${embedded === null ? "workbench" : "kernel"} does not answer …`;

const onePanel = () => "This window shows one panel.";
TABS.forEach(({ id, title }, n) => command({ text: `Open ${title}`, key: n < 10 ? String((n + 1) % 10) : null, group: "Tab", work: () => goToTab(id), ready: () => alone === null, why: onePanel }));
const openPanel = command({ text: "Open the panel in a window of its own", group: "Page", work: () => openWindow(openTab.value), ready: () => alone === null, why: onePanel });
noteKey("1 … 9, 0", "Open a tab", "Panels");
noteKey("w", "Why, of a line of the firing trace", "Panels");
noteKey("b", "Breakpoint, in the list of productions", "Panels");
noteKey("Enter", "Go to a line of the trace; open a run", "Panels");
noteKey("Delete", "Delete the chosen runs", "Panels", "models folder");

/** A strip at the edge of the page, in the place of a part that is collapsed. */
function CollapsedArea({ area }) {
  const { expand } = layoutCommands[area];
  return html`<button class="strip of-${area}" title=${expand.text} onClick=${() => run(expand)}><${Icon} name=${area === "timeline" ? "up" : "layout"} /><span>${AREAS[area]}</span></button>`;
}

function Work() {
  const [noScene, noPanels] = [isCollapsed("scene"), isCollapsed("panels") && hasWorld.value];
  const kinds = [hasWorld.value ? "" : "bodiless", swapped.value ? "swapped" : "", noScene ? "no-scene" : "", noPanels ? "no-panels" : ""];
  return html`<main class="work ${kinds.join(" ")}">
    <${Scene} />
    ${noScene && hasWorld.value ? html`<${CollapsedArea} area="scene" />` : null}
    <${Splitter} size=${panelsWidth} along="columns" reversed=${swapped.value} label="Width of the panels" least=${280} most=${() => innerWidth - MIN_SCENE} />
    ${noPanels ? html`<${CollapsedArea} area="panels" />` : null}
    <section class="side" aria-label="Panels">
      <${Tabs} label="Panels" tabs=${TABS} shown=${openTab} more=${html`<${AreaMenu} area="panels" opening=${openPanel} />`} />
    </section>
  </main>`;
}

function WholePage() {
  const sizes = { "--side": `${panelsWidth.value}px`, "--below": `${timelineHeight.value}px` };
  const hasTimeline = !isCollapsed("timeline");
  return html`<div class="workbench ${hurried.value ? "hurried" : ""} ${hasTimeline ? "" : "no-timeline"}" data-maximised=${maximised.value} style=${sizes}>
    ${embedded === null ? html`<${Bar} /><div><${RecordingBanner} /></div>` : html`<${NotebookBar} /><div></div>`}
    <${Work} />
    ${hasTimeline
      ? html`<section class="below" aria-label="Timeline">
          <${Splitter} size=${timelineHeight} along="rows" label="Height of the timeline" least=${80} most=${() => innerHeight - 300} />
          <${Timeline} />
        </section>`
      : html`<nav aria-label="Collapsed"><${CollapsedArea} area="timeline" /></nav>`}
    <${StatusLine} />
  </div>`;
}

/** One panel in a window of its own; links to other panels show them here, with the way back. */
function OnePanel() {
  const { title, View } = VIEWS[openTab.value] ?? PANELS[0];
  const model = session.value?.model ?? "";
  useEffect(() => {
    listModels().catch((error) => notify(error.message));
    follow(begin);
  }, []);
  useEffect(() => void (document.title = `${title} · ${model}`), [title, model]);
  return html`<div class="workbench alone ${hurried.value ? "hurried" : ""}">
    <header class="bar">${openTab.value !== alone && VIEWS[alone] ? html`<button onClick=${() => (openTab.value = alone)}><span class="back"><${Icon} name="right" /></span>${VIEWS[alone].title}</button>` : null}<h1>${title}</h1><span class="mono quiet">${model}</span><span class="stretch"></span><${Clock} /></header>
    <main class="alone-view" aria-label=${title}><${View} /></main>
    <${StatusLine} />
  </div>`;
}

/** The bar of a page in a notebook. */
function NotebookBar() {
  const { model = "", recorded = null, branched = null } = session.value ?? {};
  useEffect(() => {
    show(embedded);
    parent.postMessage("workbench", "*"); // says only that the page can be reached
  }, []);
  return html`<header class="bar">
    <h1>${recorded === null ? "ACT-R 3D" : `${branched === null ? "Recording" : "Branch of the recording"} of ${model}`}</h1>
    <${Transport} />
    <${Clock} />
  </header>`;
}

export function Workbench() {
  return html`${alone === null ? html`<${WholePage} />` : html`<${OnePanel} />`}
    <${Comparison} />
    <${Dialogs} />
    <${CommandPalette} />
    <${Toasts} />
    <div class="silence" role="status">${silent.value ? SILENT : ""}</div>`;
}
