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
  const size = useRef(0); // the height of the list when it was last looked at [px]
  const followed = useRef(null); // the shown run for which the list was scrolled

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
    const listed = new Set(ids);
    const added = [...chosen].filter((id) => !known.current.has(id) && listed.has(id));
    known.current = new Set([...known.current, ...added].filter((id) => chosen.has(id)));
    if (added.length > 0) show(added.find(isInView) ?? added[0]);
    else if (chosen.size === 0 && followed.current !== shown && listed.has(shown)) {
      followed.current = shown;
      if (kept.current.id === null ? box.current.scrollTop === 0 : kept.current.isInView) show(shown);
    }
  });

  return {
    resized() {
      const { id, isInView: wasInView } = kept.current;
      size.current = box.current.clientHeight;
      if (wasInView && rows.current.includes(id)) show(id);
    },
    scrolled() {
      const { id } = kept.current;
      const isResized = box.current.clientHeight !== size.current; // an event of an earlier scrolling: `resized` is called next
      if (!isResized && rows.current.includes(id)) kept.current = { id, isInView: isInView(id) };
    },
  };
}
