// The size of an element.

import { useLayoutEffect, useState } from "../vendor/preact.js";

/** Returns the size of an element's content [px]: {width, height}, zeros until it is known.
 *
 * @param box A ref to the element.
 * @param there Whether the component draws it now. */
export function useSize(box, there = true) {
  const [size, setSize] = useState({ width: 0, height: 0 });
  useLayoutEffect(() => {
    if (!there) return undefined;
    const watch = new ResizeObserver(([{ contentRect }]) => {
      const [width, height] = [Math.floor(contentRect.width), Math.floor(contentRect.height)];
      setSize((before) => (before.width === width && before.height === height ? before : { width, height }));
    });
    watch.observe(box.current);
    return () => watch.disconnect();
  }, [there]);
  return size;
}
