// Says that what is shown is a recording: which, of when, and how to return to what was shown before.

import { html } from "../vendor/preact.js";
import { Icon } from "../parts/icon.js";
import { whenInFull } from "../runs/words.js";
import { session, state } from "../store.js";
import { before, choose, models } from "./models.js";

export function RecordingBanner() {
  const { recorded = null, made, model, cuts = [] } = session.value ?? {};
  if (recorded === null) return null;
  const there = before.value?.model ?? (models.value.some(({ path }) => path === model) ? model : null);
  const changed = cuts.length > 0;
  return html`<div class="recording-banner" role="status">
    <b>Recording</b>
    <span>${model.split("/").at(-1)}, made ${whenInFull(made)} <span class="mono quiet">${recorded}</span></span>
    <span class="quiet">
      ${changed
        ? "You have changed its course: what follows is new, and is not recorded."
        : `${(state.value?.furthest ?? 0).toFixed(2)} s are known. Running it shows again what happened.`}
    </span>
    <span class="stretch"></span>
    ${there ? html`<button onClick=${() => choose(there)}><${Icon} name="back" />${before.value ? "Back to the run of" : "Show the model"} ${there.split("/").at(-1)}</button>` : null}
  </div>`;
}
