// The timeline: one axis of time for agents and body, for going back and forth.

import { computed, html } from "../vendor/preact.js";
import { nothingYet } from "../run_status.js";
import { curvesVersion, names } from "../timeline/curves.js";
import { lanes, lanesVersion } from "../timeline/record.js";
import { column } from "../timeline/rows.js";
import { Branches } from "../timeline/branches.js";
import { Stage } from "../timeline/canvas.js";
import { Tools } from "../timeline/tools.js";

/** The text shown if there is nothing to draw yet; otherwise empty. */
const nothing = computed(() => {
  lanesVersion.value;
  curvesVersion.value;
  return lanes.lanes.size > 0 || names.value.length > 0 ? "" : nothingYet();
});

export function Timeline() {
  return html`<div class="timeline">
    <${Tools} />
    <${Branches} />
    <div class="timeline-body">
      <${Stage} />
      ${nothing.value ? html`<p class="empty timeline-nothing" style=${{ left: `${column.value}px` }}>${nothing.value}</p>` : null}
    </div>
  </div>`;
}
