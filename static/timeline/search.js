// Looks for a place in a list that is in order.

/** Returns the number of the first entry of which something holds, where it holds of all that follow it; the length where of none. */
export function firstWhere(list, holds) {
  let [low, high] = [0, list.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (holds(list[middle])) high = middle;
    else low = middle + 1;
  }
  return low;
}
