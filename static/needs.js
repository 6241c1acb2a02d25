// What commands, keys, panels and buttons may need around the page: without it they do not exist.

import { embedded } from "./address.js";

/** Whether this page has it. A notebook has no models folder: no files with an editor, no recordings and experiments; and its cells start and
 * end the runs. */
const THERE = { "models folder": embedded === null };

/** Returns whether this page has what something needs; null if it needs nothing. */
export function isAvailable(need) {
  if (need !== null && !(need in THERE)) throw new Error(`needs: must be one of ${Object.keys(THERE).join(", ")} (got ${need})`);
  return need === null || THERE[need];
}
