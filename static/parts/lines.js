// Long text that draws only its visible lines; it stays at its end until the user scrolls away from it.

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { useVisible } from "./visible.js";

const LINE = 18; // the height of a line, as lines.css has it [px]
const SPARE = 20; // the number of lines drawn beyond the visible ones

/**
 * @param count The number of lines.
 * @param line Returns line n, drawn; all lines have the same height.
 * @param of The source of the lines: if it changes, the end is shown again.
 */
export function Lines({ label, count, line, of }) {
  const box = useRef(null);
  const atEnd = useRef(true);
  const toEnd = () => {
    if (atEnd.current && box.current) box.current.scrollTop = box.current.scrollHeight;
  };
  const view = useVisible(box, toEnd);

  function scrolled() {
    if (!box.current) return;
    const { scrollTop, clientHeight, scrollHeight } = box.current;
    atEnd.current = scrollTop + clientHeight >= scrollHeight - LINE;
    view.look();
  }

  useLayoutEffect(() => {
    atEnd.current = true;
  }, [of]);
  useLayoutEffect(() => {
    toEnd();
    view.look();
  }, [count, of]);

  const [from, to] = view.range(count, LINE, SPARE);
  const drawn = [];
  for (let n = from; n < to; n += 1) drawn.push(line(n));
  return html`<div class="lines" ref=${box} tabindex="0" role="region" aria-label=${label} onScroll=${scrolled}>
    <div style=${{ height: `${count * LINE}px`, paddingTop: `${from * LINE}px` }}>${drawn}</div>
  </div>`;
}
