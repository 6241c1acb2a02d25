// The line below: how the run stands, what it began with, who watches.

import { html } from "../vendor/preact.js";
import { Former } from "../editor/running.js";
import { connected, opening, session, state } from "../store.js";

function standing() {
  const { stuck, loading, ending, alive } = session.value ?? {};
  if (loading) return "loading …";
  if (!session.value) return opening.value ? (opening.value.slow ? "the workbench is starting …" : "loading …") : "no run";
  const busy = stuck ? ` (busy${stuck.line ? ` at line ${stuck.line}` : ""})` : "";
  if (state.value) return `${state.value.status}${state.value.reason ? `: ${state.value.reason}` : ""}${busy}`;
  return alive ? `starting${busy}` : ending || "no run";
}

export function StatusLine() {
  const { seed, watching = [], controlled_by: control, recording } = session.value ?? {};
  const level = session.value?.stuck || state.value?.status === "failed" ? "bad" : state.value?.status ?? "";
  return html`<footer class="status-line">
    <span id="status" role="status" class=${level}>${standing()}</span>
    <span class="stretch"></span>
    <${Former} />
    ${recording ? html`<span title="Kept as this recording">rec ${recording}</span>` : null}
    ${seed !== null && seed !== undefined ? html`<span title="The seed of the run">seed ${String(seed)}</span>` : null}
    <span>${state.value?.events ?? 0} events</span>
    ${watching.length > 1 ? html`<span title=${watching.join(", ")}>${watching.length} browsers${control ? `, controlled by ${control}` : ""}</span>` : null}
    <span id="connection" class=${connected.value === false ? "bad" : ""}>
      ${connected.value === false ? "connection lost; trying again …" : connected.value ? "connected" : "connecting …"}
    </span>
  </footer>`;
}
