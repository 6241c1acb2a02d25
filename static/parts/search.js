// Binary search in a sorted list.

/** Returns the index of the first entry with a property that all later entries have too; the end if there is none. Only those from `low` to
 * before `high` are looked at. */
export function firstWhere(list, holds, low = 0, high = list.length) {
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(list[middle])) high = middle;
    else low = middle + 1;
  }
  return low;
}

/** Returns the same for the entries from `low` on; fast if the entry is near. */
export function nextWhere(list, holds, low) {
  let step = 1;
  while (low + step < list.length && !holds(list[low + step])) {
    low += step;
    step *= 2;
  }
  return firstWhere(list, holds, low, Math.min(low + step, list.length));
}

/** Returns the index of the first of ascending times, from `low` on, that is not before a given time. */
export const firstFrom = (times, time, low) => firstWhere(times, (one) => one >= time, low);
