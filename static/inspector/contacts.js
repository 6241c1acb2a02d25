// Contacts of a body as rows of the trace: the recording has no event for them, so the page computes them from the curves.

import { contacts as contactCurves } from "../timeline/curves.js";
import { firstWhere } from "../parts/search.js";
import { eventAt, placeToRead } from "./event_filter.js";

/** Returns contacts as events, in order: the start of each, the body, the force and the duration. */
export function contactEvents() {
  return contactCurves.value.map(({ begins, to, from, hardest, body }) => [Math.round(begins * 1e6), body, "contact", { force: hardest, lasts: to - from }]);
}

/** Rows of events merged with contacts by time. A contact has a negative number. */
export class Mixed {
  /** @param numbers The numbers of events, in order; `contacts` the result of `contactEvents`, filtered. */
  constructor(numbers, contacts) {
    this.numbers = numbers;
    this.contacts = contacts;
    this.places = contacts.map(([time], n) => firstWhere(numbers, (number) => eventAt(number)[0] > time) + n); // their row numbers
  }

  get count() {
    return this.numbers.length + this.contacts.length;
  }

  /** Returns the number of the event or contact in a row. */
  numberAt(row) {
    const contact = this.places.indexOf(row);
    return contact >= 0 ? -1 - contact : this.numbers[placeToRead(this.numbers, row - this.places.filter((place) => place < row).length)];
  }

  /** Returns the row of the nth event. */
  rowOf(n) {
    return this.places.reduce((row, place) => (place <= row ? row + 1 : row), placeToRead(this.numbers, n));
  }

  /** Returns the row of a contact. */
  rowOfContact(number) {
    return this.places[-1 - number];
  }

  /** Returns the event or contact with a number, as an event. */
  at(number) {
    return number < 0 ? this.contacts[-1 - number] : eventAt(number);
  }
}
