// One plot of curves over time, with its scale, its axis and the values at the pointer; can be saved as PNG or SVG, and its values as CSV.

import { html, useEffect, useMemo, useRef, useSignal } from "../vendor/preact.js";
import { dark } from "../theme.js";
import { drawCurves, drawLegend, drawTimes, rangeOf, seriesColour, valueAt } from "./curve.js";
import { csvText } from "./csv.js";
import { saveFile, savePicture } from "./picture.js";
import { SaveButtons } from "./save_buttons.js";
import { useSize } from "./size.js";
import { CanvasSurface, scaled } from "./surface.js";
import { numberText } from "./ticks.js";
import { timeText } from "./units.js";

const LEFT = 46; // the width of the scale [px]
const RIGHT = 32; // half of the last label of the axis is there [px]
const AXIS = 18; // [px]

function boxOf(width, height) {
  return { x: LEFT, y: 4, width: Math.max(10, width - LEFT - RIGHT), height: Math.max(10, height - AXIS - 4) };
}

/** Returns the first and last time of some curves [s]. */
function spanOf(series, times) {
  const all = series.map(({ times: own }) => own ?? times).filter((list) => list?.length);
  const [from, to] = [Math.min(...all.map((list) => list[0])), Math.max(...all.map((list) => list.at(-1)))];
  return to > from ? { from, to } : { from: 0, to: 1 };
}

function drawPlot(surface, width, height, { series, times, span, range, at }) {
  const box = boxOf(width, height);
  drawTimes(surface, box, span, { y: box.y + box.height, height: AXIS, room: { from: 0, to: width } });
  drawCurves(surface, box, { series, times, span, range });
  if (at === null || at < span.from || at > span.to) return;
  const x = Math.round(box.x + ((at - span.from) / (span.to - span.from)) * box.width) + 0.5;
  surface.line([x, box.y, x, box.y + box.height], "strong-line");
}

/**
 * @param title The title of the plot.
 * @param series [{name, unit, values, times?, colour?, dash?}]: curves that share a scale; null is a gap. One with its own `times` [s]
 *   is drawn over the others, such as a curve of another run.
 * @param times The moments of all the others [s], ascending.
 * @param span {from, to}: the visible times [s]; by default the whole length of the curves.
 * @param height [px]
 * @param cursor A signal with the time at the pointer [s], or null: plots that share it show the same moment.
 * @param onPick Called with the time where the user clicks [s].
 * @param source Shown in a picture beside the title: the model, run and seed.
 */
export function Plot({ title, series, times = [], span = null, height = 120, cursor = null, onPick = null, source = "" }) {
  const canvas = useRef(null);
  const own = useSignal(null);
  const area = useRef(null);
  const { width } = useSize(area);
  const pointed = cursor ?? own;
  const shown = span ?? spanOf(series, times);
  const range = useMemo(() => rangeOf(series), [series]);
  const unit = series[0]?.unit ?? "";
  const at = pointed.value;

  useEffect(() => {
    const context = scaled(canvas.current, width, height);
    if (width > 0) drawPlot(new CanvasSurface(context), width, height, { series, times, span: shown, range, at });
  }, [series, times, times.length, shown.from, shown.to, range, at, width, height, dark.value]);

  function timeOf(event) {
    const box = boxOf(width, height);
    const time = shown.from + ((event.offsetX - box.x) / box.width) * (shown.to - shown.from);
    return Math.min(Math.max(time, shown.from), shown.to);
  }

  function save(kind) {
    const name = [title, source].filter(Boolean).join(" ");
    if (kind === "csv") {
      const curves = series.map((one) => ({ ...one, name: `${title} ${one.name}`, times: one.times ?? times }));
      return saveFile(`${name}.csv`, new Blob([csvText(curves)], { type: "text/csv" }));
    }
    const wide = Math.max(640, width);
    const draw = (surface) => {
      drawLegend(surface, LEFT, 8, wide - LEFT, series);
      const below = { ...boxOf(wide, height), y: 24 };
      drawTimes(surface, below, shown, { y: below.y + below.height, height: AXIS, room: { from: 0, to: wide } });
      drawCurves(surface, below, { series, times, span: shown, range });
    };
    return savePicture({ name, title: `${title}${unit ? ` [${unit}]` : ""}${source ? `, ${source}` : ""}`, width: wide, height: height + 24, draw }, kind);
  }

  return html`<figure class="plot" aria-label=${title}>
    <figcaption>
      <b title=${title}>${title}</b>${unit ? html` <span class="quiet">[${unit}]</span>` : null}
      <span class="plot-names">
        ${series.map(({ name, colour, dash, ...curve }, n) => {
          const value = at === null ? "" : numberText(valueAt({ times, ...curve }, at));
          return html`<span key=${n} class="plot-name" title=${name}>
            <svg width="14" height="8" aria-hidden="true"><line x1="0" y1="4" x2="14" y2="4" stroke="var(--${colour ?? seriesColour(n)})" stroke-width="2" stroke-dasharray=${(dash ?? []).join(" ")} /></svg>
            <span class="plot-of">${name}</span> <output>${value}</output>
          </span>`;
        })}
      </span>
      <span class="plot-time number quiet">${at === null ? "" : timeText(at, 2, shown.to)}</span>
      <${SaveButtons} what="plot" kinds=${["png", "svg", "csv"]} save=${save} />
    </figcaption>
    <div ref=${area} class="plot-area" style=${{ height: `${height}px` }}>
      <canvas
        ref=${canvas}
        role="img"
        aria-label="${title}: ${series.map(({ name }) => name).join(", ")}"
        style=${{ height: `${height}px` }}
        onPointerMove=${(event) => (pointed.value = timeOf(event))}
        onPointerLeave=${() => (pointed.value = null)}
        onClick=${onPick && ((event) => onPick(timeOf(event)))}
      ></canvas>
    </div>
  </figure>`;
}
