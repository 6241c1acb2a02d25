// The note at the very start of a run: its panels show what is before the first event.

import { html } from "../vendor/preact.js";
import { session, state } from "../store.js";

export function AtStart() {
  if (!session.value || state.value?.status !== "paused" || state.value.time > 0) return null; // a run may also be over at time 0
  return html`<p class="at-start quiet">This is before the first event: <code>init()</code> and the first productions come with the first tick.</p>`;
}
