// Where something touches a body, as rows of the trace: the recording has no event for it, so the page makes them of the curves.

import { contacts } from "../timeline/curves.js";
import { firstWhere } from "../timeline/search.js";
import { eventAt } from "./sifted.js";

/** Returns touches as events, in their order: when each begins, who is touched, how hard and for how long. */
export function touchEvents() {
  return contacts.value.map(({ begins, to, from, hardest, body }) => [Math.round(begins * 1e6), body, "contact", { force: hardest, lasts: to - from }]);
}

/** Rows of events with touches between them, by their times. A touch is known by a number below 0. */
export class Mixed {
  /** @param numbers The numbers of events, in their order; `touches` what `touchEvents` returns of those that are wanted. */
  constructor(numbers, touches) {
    this.numbers = numbers;
    this.touches = touches;
    this.places = touches.map(([time], n) => firstWhere(numbers, (number) => eventAt(number)[0] > time) + n); // the rows that they have
  }

  get count() {
    return this.numbers.length + this.touches.length;
  }

  /** Returns the number of what is in a row. */
  numberAt(row) {
    const touch = this.places.indexOf(row);
    return touch >= 0 ? -1 - touch : this.numbers[row - this.places.filter((place) => place < row).length];
  }

  /** Returns the row of the nth event. */
  rowOf(n) {
    return this.places.reduce((row, place) => (place <= row ? row + 1 : row), n);
  }

  /** Returns the row of a touch. */
  rowOfTouch(number) {
    return this.places[-1 - number];
  }

  /** Returns what has a number, as an event. */
  at(number) {
    return number < 0 ? this.touches[-1 - number] : eventAt(number);
  }
}
