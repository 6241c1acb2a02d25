// A filtered list of the run's events, by their numbers, updated as the list grows: each event is checked once.

import { useMemo } from "../vendor/preact.js";
import { events } from "../store.js";
import { firstWhere } from "../parts/search.js";

export class EventFilter {
  /** @param takes Returns whether an event is wanted. */
  constructor(takes) {
    this.takes = takes;
    this.numbers = [];
    this.first = 0;
    this.next = 0;
    this.last = null;
  }

  /** Checks the new events; or all of them if the run has changed its past, or earlier ones were added. */
  update({ list, first }) {
    let known = this.next - first;
    if (first < this.first || known < 0 || known > list.length || (known > 0 && list[known - 1] !== this.last)) {
      this.numbers = [];
      known = 0;
    } else if (this.numbers.length > 0 && this.numbers[0] < first) {
      this.numbers.splice(0, this.below(first));
    }
    for (; known < list.length; known += 1) if (this.takes(list[known])) this.numbers.push(first + known);
    this.first = first;
    this.next = first + list.length;
    this.last = list.at(-1) ?? null;
    return this;
  }

  /** Returns the number of filtered events before an event. */
  below(number) {
    return firstWhere(this.numbers, (one) => one >= number);
  }
}

/** Returns the filtered events at this moment; `key` differs if the filter does. */
export function useEventFilter(takes, key) {
  const filtered = useMemo(() => new EventFilter(takes), [key]);
  return filtered.update(events.value);
}

/** Returns whether the nth of some events, by their numbers, is a change by hand, and the one before it is its effect, which is recorded first. */
function isAfterEffect(numbers, n) {
  if (!(n > 0) || n >= numbers.length || numbers[n - 1] !== numbers[n] - 1) return false;
  const [[before, source], [time, , kind, data]] = [eventAt(numbers[n - 1]), eventAt(numbers[n])];
  if (kind !== "command" || before !== time) return false;
  const { values = [], named = {} } = data.data ?? {};
  return [...values, ...Object.values(named)].includes(source);
}

/** Returns the place at which the nth of some events is read, by their numbers: a change by hand before its effect. */
export function placeToRead(numbers, n) {
  return isAfterEffect(numbers, n) ? n - 1 : isAfterEffect(numbers, n + 1) ? n + 1 : n;
}

/** Returns an event by its number. */
export function eventAt(number) {
  const { list, first } = events.peek();
  return list[number - first];
}
