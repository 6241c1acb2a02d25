// The line below: how the run stands, what it began with, who watches.

import { html } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { Former } from "../editor/running.js";
import { standing } from "../standing.js";
import { connected, session, state } from "../store.js";

const BAD = ["busy", "failed", "lost", "unloadable"];

export function StatusLine() {
  const { seed, watching = [], controlled_by: control, recording } = session.value ?? {};
  const { is, line } = standing.value;
  return html`<footer class="status-line">
    <span id="status" role="status" class=${BAD.includes(is) ? "bad" : is} title=${line}>${line}</span>
    <span class="stretch"></span>
    <${Former} />
    ${recording ? html`<span title="Kept as this recording">rec ${recording}</span>` : null}
    ${seed !== null && seed !== undefined ? html`<span title="The seed of the run">seed ${String(seed)}</span>` : null}
    <span>${counted(state.value?.events ?? 0, "event")}</span>
    ${watching.length > 1 ? html`<span title=${watching.join(", ")}>${watching.length} browsers${control ? `, controlled by ${control}` : ""}</span>` : null}
    <span id="connection" class=${connected.value === false ? "bad" : ""}>
      ${connected.value === false ? "connection lost; trying again …" : connected.value ? "connected" : "connecting …"}
    </span>
  </footer>`;
}
