// A long table of which only the rows in sight are drawn; all rows are equally high.

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";

export const ROW = 23; // the height of a row, as panels/productions.css has it [px]
const HEAD = 26; // and of the head [px]
const SPARE = 12; // so many rows are drawn beyond what is in sight

/**
 * @param count How many rows there are.
 * @param row Returns row n.
 * @param head The cells of the head.
 * @param aim The number of a row that is kept in sight, as long as the user does not scroll away from it; null for none.
 * @param chosen The number of the row that the keyboard is at, or null; `onChoose` is told another.
 * @param onOpen Is told the row on which Enter is pressed.
 * @param keys Other keys: what is done with the chosen row, by name.
 */
export function Rows({ id, label, count, row, head, columns, aim = null, chosen = null, onChoose, onOpen, keys = {}, empty = null }) {
  const box = useRef(null);
  const set = useRef(0);
  const away = useRef(false);
  const [view, setView] = useState({ top: 0, height: 400 });
  const last = useRef(chosen);
  const known = useRef(count);

  // A scrolled or observed box may be gone when that is told.
  function look() {
    if (!box.current) return;
    const { scrollTop: top, clientHeight: height } = box.current;
    setView((before) => (before.top === top && before.height === height ? before : { top, height }));
  }

  function show(n) {
    const { scrollTop, clientHeight } = box.current;
    const top = n * ROW;
    if (top < scrollTop) box.current.scrollTop = top;
    else if (top + ROW + HEAD > scrollTop + clientHeight) box.current.scrollTop = top + ROW + HEAD - clientHeight;
  }

  function scrolled() {
    if (!box.current) return;
    const { scrollTop, clientHeight } = box.current;
    if (aim !== null && Math.abs(scrollTop - set.current) > 2) {
      const top = aim * ROW;
      away.current = top + ROW / 2 < scrollTop || top + ROW / 2 + HEAD > scrollTop + clientHeight;
    }
    look();
  }

  useLayoutEffect(() => {
    const watcher = new ResizeObserver(look);
    watcher.observe(box.current);
    return () => watcher.disconnect();
  }, []);
  useLayoutEffect(() => {
    if (count < known.current) {
      // They are another run's, or the first are gone, and others stand here now.
      away.current = false;
      set.current = box.current.scrollTop;
    } else if (Math.abs(box.current.scrollTop - set.current) > 2) scrolled(); // of which nothing may have been told yet
    known.current = count;
    if (aim !== null && !away.current) {
      show(aim);
      set.current = box.current.scrollTop;
    }
    look();
  }, [aim, count, view.height]);
  useLayoutEffect(() => {
    if (chosen !== null && chosen !== last.current) show(chosen);
    last.current = chosen;
  }, [chosen]);

  function press(event) {
    const at = chosen ?? aim ?? -1;
    const page = Math.max(1, Math.floor(view.height / ROW) - 2);
    const to = { ArrowUp: at - 1, ArrowDown: at + 1, PageUp: at - page, PageDown: at + page, Home: 0, End: count - 1 }[event.key];
    if (to !== undefined && count > 0) {
      const n = Math.max(0, Math.min(count - 1, to));
      onChoose?.(n);
      show(n); // also where it was chosen before
    } else if (event.target === box.current && event.key === "Enter" && chosen !== null) onOpen?.(chosen);
    else if (event.target === box.current && keys[event.key] && chosen !== null) keys[event.key](chosen);
    else return;
    event.preventDefault();
  }

  function newest() {
    away.current = false;
    show(aim);
    look();
  }

  const from = Math.max(0, Math.floor(Math.min(view.top, count * ROW - view.height) / ROW) - SPARE);
  const to = Math.min(count, Math.ceil((view.top + view.height) / ROW) + SPARE);
  const drawn = [];
  for (let n = from; n < to; n += 1) drawn.push(row(n));
  return html`<div class="rows-frame">
    <div class="rows" ref=${box} tabindex="0" role="region" aria-label=${label} onScroll=${scrolled} onKeyDown=${press}>
      <table id=${id} role="grid" aria-label=${label} aria-rowcount=${count}>
        ${columns ? html`<colgroup>${columns.map((width, n) => html`<col key=${n} style=${{ width }} />`)}</colgroup>` : null}
        <thead>
          <tr>${head}</tr>
        </thead>
        <tbody>
          ${from > 0 ? html`<tr key="above" class="gap" aria-hidden="true" style=${{ height: `${from * ROW}px` }}></tr>` : null} ${drawn}
          ${to < count ? html`<tr key="below" class="gap" aria-hidden="true" style=${{ height: `${(count - to) * ROW}px` }}></tr>` : null}
        </tbody>
      </table>
      ${count === 0 ? empty : null}
    </div>
    ${aim !== null && away.current ? html`<button class="to-newest" onClick=${newest}>To the present ↓</button>` : null}
  </div>`;
}
