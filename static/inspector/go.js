// Goes to the moment of an event.

import { session } from "../store.js";
import { travel } from "../timeline/seek.js";
import { eventAt } from "./event_filter.js";

/** Takes the run to its first stop after an event. */
export function goTo(number) {
  const { kind, period } = session.peek();
  const tick = kind === "program" ? 1 : Math.round(period * 1e6);
  travel((Math.ceil(eventAt(number)[0] / tick) * tick) / 1e6);
}
