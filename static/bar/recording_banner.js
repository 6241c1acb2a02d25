// Shows that this is a recording: which one, from when, and a link back to what was shown before.

import { html, useEffect, useSignal } from "../vendor/preact.js";
import { Icon } from "../parts/icon.js";
import { timeText } from "../parts/units.js";
import { runs } from "../runs/list.js";
import { branchText, openText, ownName, whenInFull } from "../runs/wording.js";
import { session, state } from "../store.js";
import { before, choose, models, otherSessions, showSession } from "./models.js";

/** The other open sessions, the newest of each model or recording. */
function useOthers(id) {
  const others = useSignal([]);
  useEffect(() => {
    let mine = true;
    otherSessions(id).then(
      (list) => mine && (others.value = list),
      () => null, // without a list, only the way back is shown
    );
    return () => (mine = false);
  }, [id]);
  return others.value;
}

/** Links to the other open sessions: one link, or a list if there are several. */
function Others({ id, model }) {
  const others = useOthers(id);
  if (others.length > 1) {
    const show = ({ currentTarget: list }) => showSession(others.find((one) => one.id === list.value));
    return html`<select aria-label="Open runs" value="" onChange=${show}>
      <option value="" disabled>${others.length} other runs are open</option>
      ${others.map((one) => html`<option key=${one.id} value=${one.id}>${openText(one, runs.value)}</option>`)}
    </select>`;
  }
  const there = before.value?.model ?? (models.value.some(({ path }) => path === model) ? model : null);
  if (there === null) return null;
  return html`<button title=${there} onClick=${() => choose(there)}>
    <${Icon} name="back" />${before.value ? html`Back to the run of${" "}<span class="path"><bdi>${there}</bdi></span>` : "Show the model"}
  </button>`;
}

/** What becomes of the run that is shown: a text, and its explanation. */
function fate({ recording, branched }) {
  if (recording !== null) return ["Recorded as a branch", "It differs from the recording that was opened, or goes beyond it; this is recorded as a branch."];
  if (branched) return ["No longer recorded", "It differs from the recording that was opened, or goes beyond it; this is not recorded."];
  return [`${timeText(state.value?.furthest ?? 0)} recorded`, "Running it shows again what happened."];
}

export function RecordingBanner() {
  const { id, recorded = null, made, model } = session.value ?? {};
  if (recorded === null) return null;
  const [text, why] = fate(session.value);
  const run = runs.value?.find(({ id }) => id === recorded);
  const name = run && (ownName(run) || branchText(run));
  const when = made === null ? "deleted or renamed since it was opened" : `made ${whenInFull(made)}`;
  return html`<div class="recording-banner" role="status">
    <b>Recording</b>
    <div class="of">
      <span class="name" title=${recorded}>${name ? html`<b>${name}</b>` : html`<span class="mono">${recorded}</span>`}</span>
      <div class="facts quiet">
        <span class="path" title=${model}><bdi>${model}</bdi></span>
        <span class="when" title=${when}>${when}</span>
        <span title=${why}>${text}</span>
      </div>
    </div>
    <${Others} id=${id} model=${model} />
  </div>`;
}
