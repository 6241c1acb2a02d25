// A long table that draws only its visible rows; all rows have the same height.

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { useVisible } from "../parts/visible.js";

const ROW = 23; // the height of a row, as inspector/rows.css has it [px]
const HEAD = 26; // the height of the head [px]
const SPARE = 12; // the number of rows drawn beyond the visible ones

/**
 * @param count The number of rows.
 * @param row Returns row n, a `tr` with these attributes.
 * @param head The cells of the head.
 * @param columns The widths of the columns.
 * @param aim The number of a row that stays visible until the user scrolls away from it; null for none.
 * @param chosen The number of the row selected by keyboard, or null; `onChoose` is called with a new one.
 * @param onOpen Called with the row on which Enter is pressed.
 * @param keys Other keys: actions on the chosen row, by key name.
 */
export function Rows({ id, label, count, row, head, columns, aim = null, chosen = null, onChoose, onOpen, keys = {}, empty }) {
  const box = useRef(null);
  const set = useRef(0);
  const away = useRef(false);
  const view = useVisible(box);
  const last = useRef(chosen);
  const known = useRef(count);

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
    view.look();
  }

  useLayoutEffect(() => {
    if (count < known.current) {
      // They belong to another run, or the first ones are gone and the numbers have shifted.
      away.current = false;
      set.current = box.current.scrollTop;
    } else if (Math.abs(box.current.scrollTop - set.current) > 2) scrolled(); // the scroll event may not have arrived yet
    known.current = count;
    if (aim !== null && !away.current) {
      show(aim);
      set.current = box.current.scrollTop;
    }
    view.look();
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
      show(n); // also if it was chosen before
    } else if (event.target === box.current && event.key === "Enter" && chosen !== null) onOpen?.(chosen);
    else if (event.target === box.current && keys[event.key] && chosen !== null) keys[event.key](chosen);
    else return;
    event.preventDefault();
  }

  function newest() {
    away.current = false;
    show(aim);
    view.look();
  }

  const rowId = (n) => `${id}-${n}`;
  const [from, to] = view.range(count, ROW, SPARE);
  const drawn = [];
  for (let n = from; n < to; n += 1) drawn.push(row(n, { id: rowId(n), "aria-rowindex": n + 2, "aria-selected": n === chosen }));
  return html`<div class="rows-frame">
    <div class="rows" ref=${box} tabindex="0" role="group" aria-label=${label} aria-activedescendant=${chosen >= from && chosen < to ? rowId(chosen) : null} onScroll=${scrolled} onKeyDown=${press}>
      <table id=${id} role="grid" aria-label=${label} aria-rowcount=${count + 1}>
        <colgroup>${columns.map((width, n) => html`<col key=${n} style=${{ width }} />`)}</colgroup>
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
