// The status line: the state of the run, its initial settings, and the number of viewers.

import { html } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { Branch } from "./branch.js";
import { StaleRunNote } from "../editor/stale_run.js";
import { Hint } from "./pace.js";
import { Share } from "./share.js";
import { runStatus } from "../run_status.js";
import { silent } from "../silence.js";
import { embedded } from "../address.js";
import { connected, eventCount, me, restarted, session, state } from "../store.js";

const LOST = embedded === null ? "connection lost; trying again …" : "the kernel does not answer any more: run the cell again";
const RESTARTED = embedded === null ? "the workbench was started again: open the address that it printed" : LOST;
const BAD = ["busy", "halted", "failed", "lost", "unloadable"];

/** Returns the number of pages that show the run, and who sent the last command. */
function pagesText(watching, control) {
  const who = control === me.value ? ", you are in control" : control ? ", another one is in control" : "";
  return `${watching.length} pages show this run${who}`;
}

export function StatusLine() {
  const { seed, watching = [], controlled_by: control, recording, not_kept: notKept = null } = session.value ?? {};
  const { is, line } = runStatus.value;
  return html`<footer class="status-line">
    <span id="status" role="status" class=${BAD.includes(is) ? "bad" : is} title=${line}>${line}</span>
    <span class="if-room hint"><${Hint} /></span>
    <${Branch} />${embedded === null ? html`<${StaleRunNote} />` : null}
    <span class="if-room facts">
      ${watching.length > 1 ? html`<span id="browsers" title="All can control the run; the last to do something is in control">${pagesText(watching, control)}</span>` : null}
      <span>${counted(eventCount.value, "event")}</span>
      ${seed !== null && seed !== undefined ? html`<span title="The seed of the run">seed ${String(seed)}</span>` : null}
      ${notKept ? html`<span title=${notKept}>not kept</span>` : null}
      ${recording ? html`<span title="Kept as this recording">rec ${recording}</span>` : null}
    </span>
    ${embedded === null ? html`<${Share} />` : null}
    <span id="connection" role="status" class=${connected.value === false || silent.value ? "bad" : ""}>
      ${silent.value ? "no answer" : connected.value === false ? (restarted.value ? RESTARTED : LOST) : connected.value ? "connected" : "connecting …"}
    </span>
  </footer>`;
}
