// Breakpoints: productions after which the run pauses; shared by all viewers.

import { computed, html } from "../vendor/preact.js";
import { optimistic } from "../parts/optimistic_value.js";
import { toggled } from "../parts/toggled.js";
import { sendCommand } from "../server.js";
import { session, state } from "../store.js";

const list = optimistic(
  () => session.value?.breakpoints ?? [],
  (productions) => ({ type: "breakpoints", productions }),
);

export const breakpoints = list.value;

/** The production at whose breakpoint the run is paused; null if there is none. */
export const held = computed(() => state.value?.breakpoint ?? null);

/** Sets a breakpoint on a production, or removes it. */
export function toggleBreakpoint(name) {
  list.set(toggled(breakpoints.value, name));
}

/** Shows that the run is paused at a breakpoint. */
export function HeldNote() {
  const name = held.value;
  if (name === null) return null;
  return html`<p class="held" role="status">
    <span>Paused at the breakpoint on <b class="mono">${name}</b></span>
    <span class="stretch"></span>
    <button onClick=${() => sendCommand({ type: "run" })}>Go on</button>
    <button onClick=${() => toggleBreakpoint(name)}>Remove it</button>
  </p>`;
}
