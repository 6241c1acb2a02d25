// What the user wants to have explained: which production, and of which moment.

import { computed, effect, signal } from "../vendor/preact.js";
import { remembered } from "../remembered.js";
import { events, session } from "../store.js";
import { eventAt } from "./sifted.js";

/** The production that is explained: {system, name}; null for whichever is of interest at that moment. */
export const production = signal(null);
/** The moment that is explained [s]; null for the present one. */
export const at = signal(null);
/** Which of the explanations is shown: "why", "conflict" or "retrievals". */
export const shownReasons = remembered("reasons", "why");

const run = computed(() => `${session.value?.id} ${session.value?.run}`);
effect(() => {
  run.value;
  at.value = null;
});

/** The question that is asked of the run. */
export const question = computed(() => (at.value === null ? { type: "explain" } : { type: "explain", at: at.value }));

/** Explains the moment of an event; of a firing that of the choice that led to it, for when it has fired that is over. */
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
  if (data.production) {
    production.value = { system: source, name: data.production };
    shownReasons.value = "why";
  }
}
