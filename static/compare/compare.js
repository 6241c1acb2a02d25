// Compares two recordings side by side on the whole page: their settings, results, first difference between traces, and curves.

import { html, signal, useEffect, useLayoutEffect, useRef, useSignal } from "../vendor/preact.js";
import { buttonTitle } from "../keys.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { call } from "../server.js";
import { shownRecording } from "../store.js";
import { beginningText, ownName } from "../runs/wording.js";
import { Curves, SIDE_COLOURS } from "./curves.js";
import { Difference } from "./difference.js";
import { Changes, SideBySide } from "./sides.js";

/** The ids of the two recordings; null if none are compared. */
const pair = signal(null);

/** Shows two recordings side by side. */
export function compareRuns(first, second) {
  pair.value = [first, second];
}

function useComparison(kinds) {
  const found = useSignal({ answer: null, error: null, waiting: true });
  const key = JSON.stringify([pair.value, kinds]);
  useEffect(() => {
    const leave = new AbortController();
    const [first, second] = pair.value;
    found.value = { ...found.value, waiting: true };
    call("POST", "/api/compare", { first, second, kinds }, leave.signal)
      .then((answer) => (found.value = { answer, error: null, waiting: false }))
      .catch((error) => !leave.signal.aborted && (found.value = { answer: null, error: error.message, waiting: false }));
    return () => leave.abort();
  }, [key]);
  return found.value;
}

function Head({ runs }) {
  return html`<div class="compare-runs">
    ${runs.map(
      (run, n) => html`<span key=${n} class="compare-run" title=${run.id}>
        <svg width="14" height="14" aria-hidden="true"><rect width="14" height="14" rx="3" fill="var(--${SIDE_COLOURS[n]})" /></svg>
        <b>${ownName(run) || run.model}</b> <span class="number">${beginningText(run)}</span>${run.id === shownRecording.value ? html` <b class="mark">present</b>` : null}
      </span>`,
    )}
  </div>`;
}

function Contents({ answer, waiting, error, kinds }) {
  if (error) return html`<${Problem} text=${`They cannot be compared: ${error}`} />`;
  if (!answer) return html`<p class="empty" role="status"><progress aria-label="Comparing"></progress> Comparing …</p>`;
  const [one, other] = answer.runs;
  return html`<div class="compare-parts" aria-busy=${waiting}>
    <div class="compare-facts">
      ${one.model === other.model ? null : html`<p class="note">These are two different models: what they have in common is compared, and their traces differ from the start.</p>`}
      <${SideBySide} runs=${answer.runs} changed=${answer.changed} units=${answer.units} />
      <${Changes} lines=${answer.text} />
    </div>
    <div class="compare-course">
      <${Difference} answer=${answer} waiting=${waiting} kinds=${kinds} />
      <${Curves} runs=${answer.runs} />
    </div>
  </div>`;
}

function Dialog() {
  const box = useRef(null);
  const kinds = useSignal([]);
  const found = useComparison(kinds.value);
  useLayoutEffect(() => box.current.showModal(), []);

  return html`<dialog ref=${box} class="compare" aria-labelledby="compare-title" onClose=${() => (pair.value = null)}>
    <div class="compare-head">
      <h2 id="compare-title">Two runs</h2>
      ${found.answer ? html`<${Head} runs=${found.answer.runs} />` : html`<span class="stretch"></span>`}
      <button class="bare" title="Swap sides" onClick=${() => (pair.value = pair.value.toReversed())}>Swap sides</button>
      <button class="bare" aria-label="Close" title=${buttonTitle({ key: "Escape" }, "Close")} onClick=${() => box.current.close()}><${Icon} name="close" /></button>
    </div>
    <${Contents} ...${found} kinds=${kinds} />
  </dialog>`;
}

/** The container of the comparison. */
export function Comparison() {
  return pair.value ? html`<${Dialog} />` : null;
}
