// Binary search in a sorted list.

/** Returns the index of the first entry with a property that all later entries have too; the length if there is none. */
export function firstWhere(list, holds) {
  let [low, high] = [0, list.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(list[middle])) high = middle;
    else low = middle + 1;
  }
  return low;
}
