// The layout: the top bar, the 3D view beside the tabs, the timeline below, and the status line.

import { effect, html } from "./vendor/preact.js";
import { Bar } from "./bar/bar.js";
import { RecordingBanner } from "./bar/recorded.js";
import { StatusLine } from "./bar/status.js";
import { bindKey, noteKey } from "./keys.js";
import { openTab } from "./open_tab.js";
import { PANELS } from "./panels.js"; // made by the server: all files of panels/ that export a panel
import { Dialogs } from "./parts/dialog.js";
import { Splitter } from "./parts/splitter.js";
import { Tabs } from "./parts/tabs.js";
import { Toasts } from "./parts/toasts.js";
import { Scene } from "./panels/scene.js";
import { Timeline } from "./panels/timeline.js";
import { remembered } from "./local_storage.js";
import { hurried, session } from "./store.js";

const LEAST_SCENE = 320; // [px]
const ROWS = 336; // the height of the default rows of a model with a body [px]
// By default, all tabs can be seen, and wide windows give the panels more room too.
const side = remembered("side width", Math.max(736, Math.round(0.38 * innerWidth)));
/** Whether there is a 3D view; otherwise the panels have all the room. */
const hasWorld = remembered("has world", true); // while a model loads, that of the previous one
effect(() => {
  if (session.value?.kind) hasWorld.value = Boolean(session.value.world);
});
const below = remembered("timeline height", Math.round(Math.min(0.42 * innerHeight, Math.max(ROWS, 0.34 * innerHeight))));

PANELS.slice(0, 10).forEach(({ id }, n) => bindKey(String((n + 1) % 10), "", () => (openTab.value = id)));
noteKey("1 … 9, 0", "Open a tab", "Panels");
noteKey("w", "Why, of a line of the firing trace", "Panels");
noteKey("b", "Breakpoint, in the list of productions", "Panels");
noteKey("Enter", "Go to a line of the trace; open a run", "Panels");
noteKey("Delete", "Delete the chosen runs", "Panels");

export function Workbench() {
  const sizes = { "--side": `${side.value}px`, "--below": `${below.value}px` };
  return html`
    <div class="workbench ${hurried.value ? "hurried" : ""}" style=${sizes}>
      <${Bar} />
      <div><${RecordingBanner} /></div>
      <main class="work ${hasWorld.value ? "" : "bodiless"}">
        <${Scene} />
        <${Splitter} size=${side} along="columns" label="Width of the panels" least=${280} most=${() => innerWidth - LEAST_SCENE} />
        <section class="side" aria-label="Panels">
          <${Tabs} label="Panels" tabs=${PANELS} shown=${openTab} />
        </section>
      </main>
      <${Splitter} size=${below} along="rows" label="Height of the timeline" least=${80} most=${() => innerHeight - 300} />
      <section class="below" aria-label="Timeline"><${Timeline} /></section>
      <${StatusLine} />
    </div>
    <${Dialogs} />
    <${Toasts} />
  `;
}
