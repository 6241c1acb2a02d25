// The timeline: one axis of time for mind and body, on which one goes back and forth.

import { computed, html } from "../vendor/preact.js";
import { noSession, over, session, state } from "../store.js";
import { curvesVersion, names } from "../timeline/curves.js";
import { lanes, lanesVersion } from "../timeline/record.js";
import { column } from "../timeline/rows.js";
import { Stage } from "../timeline/stage.js";
import { Tools } from "../timeline/tools.js";

/** What is said where there is nothing to show yet; an empty text where there is. */
const nothing = computed(() => {
  lanesVersion.value;
  curvesVersion.value;
  if (lanes.lanes.size > 0 || names.value.length > 0) return "";
  if (!session.value) return noSession("Choose a model above: what its mind and body do is shown here over time.");
  if (over.value) return "Nothing has happened in this run: no model made anything to show here.";
  return state.value ? "Nothing has happened yet. Press Run or step: what mind and body do is shown here over time." : "The run has not begun.";
});

export function Timeline() {
  return html`<div class="timeline">
    <${Tools} />
    <div class="timeline-body">
      <${Stage} />
      ${nothing.value ? html`<p class="empty timeline-nothing" style=${{ left: `${column.value}px` }}>${nothing.value}</p>` : null}
    </div>
  </div>`;
}
