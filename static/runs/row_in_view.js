// Keeps the chosen row of a list of runs in view.

import { useLayoutEffect, useRef } from "../vendor/preact.js";

/** Scrolls a list so that a whole row is in view: when it is chosen, and when the list is resized, unless the user has scrolled away from it.
 * As long as nothing was chosen, this is the row of the shown run. Returns {resized, scrolled}, to be called when the list is.
 *
 * @param box A ref to the list, whose head stays at its top.
 * @param ids The ids of all rows.
 * @param chosen The ids of the chosen rows.
 * @param shown The id of the shown run; null for none.
 * @param height The height of a row [px]. */
export function useRowInView(box, ids, chosen, shown, height) {
  const rows = useRef(ids);
  rows.current = ids;
  const known = useRef(new Set()); // the chosen rows for which the list was scrolled
  const kept = useRef({ id: null, isInView: false });

  /** Returns the lowest and the highest scroll position at which a row is whole in view; in a very low list, its top is. */
  function placesOf(id) {
    const number = rows.current.indexOf(id);
    const lowest = box.current.querySelector("thead").offsetHeight + (number + 1) * height - box.current.clientHeight;
    return [lowest, number * height];
  }

  function isInView(id) {
    const [lowest, highest] = placesOf(id);
    const { scrollTop } = box.current;
    return lowest <= scrollTop + 1 && scrollTop <= highest + 1; // a scroll position may be rounded
  }

  function show(id) {
    const [lowest, highest] = placesOf(id);
    if (!isInView(id)) box.current.scrollTop = Math.min(Math.max(box.current.scrollTop, lowest), highest);
    kept.current = { id, isInView: true };
  }

  useLayoutEffect(() => {
    const added = [...chosen].filter((id) => !known.current.has(id) && ids.includes(id));
    known.current = new Set([...known.current, ...added].filter((id) => chosen.has(id)));
    if (added.length > 0) show(added.find(isInView) ?? added[0]);
    else if (kept.current.id === null && ids.includes(shown) && box.current.scrollTop === 0) show(shown);
  });

  return {
    resized() {
      const { id, isInView: wasInView } = kept.current;
      if (wasInView && rows.current.includes(id)) show(id);
    },
    scrolled() {
      const { id } = kept.current;
      if (rows.current.includes(id)) kept.current = { id, isInView: isInView(id) };
    },
  };
}
