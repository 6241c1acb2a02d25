// The explanation that the user requests: of which production, and at which moment.

import { computed, effect, signal } from "../vendor/preact.js";
import { remembered } from "../local_storage.js";
import { events, shownRun } from "../store.js";
import { eventAt } from "./event_filter.js";

/** The production to explain: {system, name}; null for the relevant one at that moment. */
export const production = signal(null);
/** The moment to explain [s]; null for the current one. */
export const at = signal(null);
/** The explanation that is shown: "why", "conflict" or "retrievals". */
export const shownReasons = remembered("reasons", "why");

effect(() => {
  shownRun.value;
  at.value = null;
});

/** Explains why a production matches or not. */
export function explainProduction(system, name) {
  production.value = { system, name };
  shownReasons.value = "why";
}

/** The question sent to the run. */
export const question = computed(() => (at.value === null ? { type: "explain" } : { type: "explain", at: at.value }));

/** Explains the moment of an event; for a firing, the moment of the choice that led to it, because its conflict is over by then. */
export function askWhy(number) {
  const [time, source, kind, data] = eventAt(number);
  let moment = time;
  if (kind === "fire") {
    const { list, first } = events.peek();
    for (let n = number - first - 1; n >= 0; n -= 1) {
      const [began, by, what] = list[n];
      if (by === source && (what === "select" || what === "fire")) {
        if (what === "select") moment = began;
        break;
      }
    }
  }
  at.value = moment / 1e6;
  if (data.production) explainProduction(source, data.production);
}
