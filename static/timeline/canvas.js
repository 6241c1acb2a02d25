// The drawn part of the timeline: the canvas, the playhead over it, and what is at the pointer.

import { effect, html, signal, useEffect, useRef, useSignal } from "../vendor/preact.js";
import { fetching } from "../earlier_events.js";
import { CanvasSurface, scaled, widthOf } from "../parts/surface.js";
import { events, running, session, state, history } from "../store.js";
import { dark } from "../theme.js";
import { reach } from "./branches.js";
import { chosen, names, plots } from "./curves.js";
import { drawPresent, drawTimeline, placeOf, secondsPerPixel, timeOf, viewOf } from "./draw.js";
import { begin, partAt, press, turn } from "./pointer.js";
import { Painter } from "./painter.js";
import { lanes, lanesVersion } from "./record.js";
import { AXIS, column, filter, heights, hidden, layout, scroll } from "./rows.js";
import { furthest, present, runTimeText } from "./seek.js";
import { found, Tip } from "./tip.js";
import { settle, span } from "./view.js";

const AROUND = 5; // the room left and right of the playhead's time in its label [px]

const size = signal({ width: 0, height: 0 });
/** The height of all rows [px]. */
const height = signal(0);

/** Returns everything that a drawing needs; `whole` is for a picture with all rows. */
export function drawing(whole = false) {
  const rows = layout(filter.peek());
  const { width, height: seen } = size.peek();
  return {
    ...viewOf(whole ? Math.max(800, width) : width),
    height: whole ? rows.height : seen,
    scroll: whole ? 0 : scroll.peek(),
    layout: rows,
    end: furthest.peek(),
    present: present.peek(),
    running: running.peek(),
    period: session.peek()?.period || 0,
    now: whole ? null : labelOfNow(),
    fetching: fetching.peek(),
    begin: events.peek().first > 0 ? (lanes.begin ?? 0) : 0,
    known: events.peek().elsewhere ? Math.max(lanes.now / 1e6, present.peek()) : Infinity,
  };
}

/** Returns the position of the playhead's label, beside which the playhead may be at the edges [px]; null if it is out of view. */
function labelOfNow() {
  const view = viewOf(size.peek().width);
  const x = placeOf(present.peek(), view);
  if (x < view.column - 1 || x > view.width + 1) return null;
  const width = Math.ceil(widthOf(runTimeText(present.peek()), { size: 10, bold: true })) + 2 * AROUND;
  const from = Math.round(Math.min(Math.max(x - width / 2, view.column + 1), view.width - width - 1));
  return { from, to: from + width, width };
}

function paint(canvas) {
  const now = drawing();
  height.value = now.layout.height;
  const context = scaled(canvas, now.width, now.height);
  if (now.width > now.column) drawTimeline(new CanvasSurface(context), now);
}

/** Draws again what depends on the playhead, on the drawing that is there. */
function paintPresent(canvas) {
  const now = drawing();
  if (canvas.width > 0 && now.width > now.column) drawPresent(new CanvasSurface(canvas.getContext("2d")), now);
}

/** Places the playhead with its label, and the veil over the future. */
function place(stage) {
  const view = viewOf(size.value.width);
  const inside = (x) => Math.min(Math.max(x, view.column), view.width);
  const [now, far] = [placeOf(present.value, view), placeOf(furthest.value, view)];
  const [veil, end, head, label] = ["veil", "end", "head", "now"].map((part) => stage.querySelector(`.timeline-${part}`));
  const there = labelOfNow();
  head.hidden = label.hidden = !there;
  if (there) Object.assign(label.style, { transform: `translateX(${there.from}px)`, width: `${there.width}px` });
  label.textContent = runTimeText(present.value);
  paintPresent(stage.querySelector("canvas"));
  head.style.transform = `translateX(${now}px)`;
  veil.style.left = `${inside(now)}px`;
  veil.style.width = `${now < far ? view.width - inside(now) : 0}px`; // also over the texts of the last marks
  end.hidden = far < view.column || far > view.width || furthest.value === 0;
  end.style.transform = `translateX(${far}px)`;
}

/** Draws changes, as long as the component is mounted. */
function attend(stage) {
  const painter = new Painter(() => paint(stage.querySelector("canvas")));
  const watch = new ResizeObserver(() => {
    size.value = { width: stage.clientWidth, height: stage.parentElement.parentElement.clientHeight };
  });
  watch.observe(stage.parentElement.parentElement);
  stage.addEventListener("wheel", turn, { passive: false });
  const ends = [
    effect(() => settle(present.value, reach.value, running.value)),
    effect(() => place(stage)),
    effect(() => {
      for (const one of [dark, span, size, scroll, filter, hidden, column, heights, chosen, names]) one.value;
      painter.ask();
    }),
    effect(() => {
      for (const one of [lanesVersion, plots, furthest, fetching]) one.value;
      painter.ask(running.value);
    }),
  ];
  return () => {
    for (const end of ends) end();
    watch.disconnect();
    painter.stop();
    stage.removeEventListener("wheel", turn);
  };
}

/** Returns what is at a position of the stage. */
function lookUp(event, stage) {
  const { left, top } = stage.getBoundingClientRect();
  const [x, y] = [event.clientX - left, event.clientY - top];
  stage.dataset.part = partAt(x, y);
  const view = viewOf(size.peek().width);
  const row = y < AXIS ? null : layout(filter.peek()).rows.find((one) => y + scroll.peek() >= one.y && y + scroll.peek() < one.y + one.height);
  if (!row) return null;
  return x < view.column ? { ...found(row, present.peek(), secondsPerPixel(view)), named: true } : found(row, timeOf(x, view), secondsPerPixel(view));
}

export function Stage() {
  const stage = useRef(null);
  const at = useSignal(null);
  useEffect(() => attend(stage.current), []);
  // What is at the pointer is known until something else is there.
  useEffect(() => {
    at.value = null;
  }, [present.value, span.value, scroll.value, history.value]);

  function hover(event) {
    const there = event.buttons ? null : lookUp(event, stage.current);
    at.value = there && { ...there, x: event.clientX, y: event.clientY };
  }

  const now = state.value ? present.value : 0;
  return html`<div class="timeline-rows" onScroll=${(event) => (scroll.value = event.currentTarget.scrollTop)}>
    <div class="timeline-all" style=${{ height: `${Math.max(height.value, size.value.height)}px` }}>
      <div
        id="timeline"
        ref=${stage}
        class="timeline-stage"
        style=${{ height: `${size.value.height}px` }}
        role="slider"
        tabindex="0"
        aria-label="Time of the run"
        aria-orientation="horizontal"
        aria-valuemin="0"
        aria-valuemax=${furthest.value}
        aria-valuenow=${now}
        aria-valuetext="${runTimeText(now)} of ${runTimeText(furthest.value)}"
        onPointerDown=${begin}
        onPointerMove=${hover}
        onPointerLeave=${() => (at.value = null)}
        onKeyDown=${press}
      >
        <canvas aria-hidden="true"></canvas>
        <div class="timeline-veil"></div>
        <div class="timeline-end" title="Newest time of the run"></div>
        <div class="timeline-head"></div>
        <div class="timeline-now" aria-hidden="true"></div>
      </div>
    </div>
    <${Tip} at=${at.value} />
  </div>`;
}
