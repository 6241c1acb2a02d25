// The visible part of a box that scrolls, for those that draw only what can be seen.

import { useLayoutEffect, useState } from "../vendor/preact.js";

/** Returns the visible part of a box [px], {top, height}; `look`, which reads it again and is to be called when the box is scrolled; and `range`,
 * which returns the numbers [from, beyond] of the visible ones of `count` rows of a height [px], and of `spare` more at each end.
 *
 * @param box A ref to the box.
 * @param resized Called when its size has changed, before its visible part is read; only what the first one refers to counts. */
export function useVisible(box, resized = () => {}) {
  const [view, setView] = useState({ top: 0, height: 400 });
  // The box may be removed before its scroll or resize event arrives.
  function look() {
    if (!box.current) return;
    const { scrollTop: top, clientHeight: height } = box.current;
    setView((before) => (before.top === top && before.height === height ? before : { top, height }));
  }
  useLayoutEffect(() => {
    const watcher = new ResizeObserver(() => {
      resized();
      look();
    });
    watcher.observe(box.current);
    look();
    return () => watcher.disconnect();
  }, []);
  function range(count, row, spare) {
    const top = Math.max(0, Math.min(view.top, count * row - view.height));
    return [Math.max(0, Math.floor(top / row) - spare), Math.min(count, Math.ceil((top + view.height) / row) + spare)];
  }
  return { ...view, look, range };
}
