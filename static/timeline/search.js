// Binary search in a sorted list.

/** Returns the index of the first entry with a property that all later entries have too; the length if there is none. */
export function firstWhere(list, holds) {
  return between(list, holds, 0, list.length);
}

/** Returns the same for the entries from `low` on; fast if the entry is near. */
export function nextWhere(list, holds, low) {
  let step = 1;
  while (low + step < list.length && !holds(list[low + step])) {
    low += step;
    step *= 2;
  }
  return between(list, holds, low, Math.min(low + step, list.length));
}

function between(list, holds, low, high) {
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(list[middle])) high = middle;
    else low = middle + 1;
  }
  return low;
}
