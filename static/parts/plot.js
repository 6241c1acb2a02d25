// One plot of curves over time, with its scale, its axis and the values at the pointer; can be saved as PNG or SVG, and its values as CSV.

import { html, useEffect, useMemo, useRef } from "../vendor/preact.js";
import { dark } from "../theme.js";
import { drawCurves, drawLegend, drawTimes, rangeOf, seriesColour, valueAt } from "./curve.js";
import { csvText } from "./csv.js";
import { saveFile, savePicture } from "./picture.js";
import { SaveButtons } from "./save_buttons.js";
import { useSize } from "./size.js";
import { CanvasSurface, scaled } from "./surface.js";
import { numberText } from "./ticks.js";
import { nameWithUnit, timeText } from "./units.js";

const LEFT = 46; // the width of the scale [px]
const RIGHT = 32; // half of the last label of the axis is there [px]
const AXIS = 18; // [px]
const LEGEND = 24; // the height of the legend of a picture [px]

function boxOf(width, height) {
  return { x: LEFT, y: 4, width: Math.max(10, width - LEFT - RIGHT), height: Math.max(10, height - AXIS - 4) };
}

function drawPlot(surface, width, height, { series, span, range, at }) {
  const box = boxOf(width, height);
  drawTimes(surface, box, span, { y: box.y + box.height, height: AXIS, room: { from: 0, to: width } });
  drawCurves(surface, box, { series, span, range });
  if (at === null || at < span.from || at > span.to) return;
  const x = Math.round(box.x + ((at - span.from) / (span.to - span.from)) * box.width) + 0.5;
  surface.line([x, box.y, x, box.y + box.height], "strong-line");
}

/** Returns curves with their legend as a picture, without its name and title: {width, height, draw}; `until` as in `drawCurves`. `height` is that of
 * the curves with their axis. */
export function pictureOfPlot({ series, span, range, until }, width, height) {
  const box = { ...boxOf(width, height), y: LEGEND };
  const draw = (surface) => {
    drawLegend(surface, LEFT, 8, width - LEFT, series);
    drawTimes(surface, box, span, { y: box.y + box.height, height: AXIS, room: { from: 0, to: width }, longest: until });
    drawCurves(surface, box, { series, span, range, until });
  };
  return { width, height: height + LEGEND, draw };
}

/**
 * @param title The title of the plot.
 * @param series [{name, unit, times, values, colour?, dash?}]: curves that share a scale; null is a gap.
 * @param span {from, to}: the visible times [s].
 * @param height [px]
 * @param cursor A signal with the time at the pointer [s], or null: plots that share it show the same moment.
 * @param source Shown in a picture beside the title: the model, run and seed.
 */
export function Plot({ title, series, span, height, cursor, source }) {
  const canvas = useRef(null);
  const area = useRef(null);
  const { width } = useSize(area);
  const range = useMemo(() => rangeOf(series), [series]);
  const unit = series[0]?.unit ?? "";
  const at = cursor.value;

  useEffect(() => {
    const context = scaled(canvas.current, width, height);
    if (width > 0) drawPlot(new CanvasSurface(context), width, height, { series, span, range, at });
  }, [series, span.from, span.to, range, at, width, height, dark.value]);

  function timeOf(event) {
    const box = boxOf(width, height);
    const time = span.from + ((event.offsetX - box.x) / box.width) * (span.to - span.from);
    return Math.min(Math.max(time, span.from), span.to);
  }

  function save(kind) {
    const name = `${title} ${source}`;
    if (kind === "csv") {
      const curves = series.map((one) => ({ ...one, name: `${title} ${one.name}` }));
      return saveFile(`${name}.csv`, new Blob([csvText(curves)], { type: "text/csv" }));
    }
    return savePicture({ ...pictureOfPlot({ series, span, range }, Math.max(640, width), height), name, title: `${nameWithUnit(title, unit)}, ${source}` }, kind);
  }

  return html`<figure class="plot" aria-label=${title}>
    <figcaption>
      <b title=${title}>${title}</b>${unit ? html` <span class="quiet">[${unit}]</span>` : null}
      <span class="plot-names">
        ${series.map(({ name, colour, dash, ...curve }, n) => {
          const value = at === null ? "" : numberText(valueAt(curve, at));
          return html`<span key=${n} class="plot-name" title=${name}>
            <svg width="14" height="8" aria-hidden="true"><line x1="0" y1="4" x2="14" y2="4" stroke="var(--${colour ?? seriesColour(n)})" stroke-width="2" stroke-dasharray=${(dash ?? []).join(" ")} /></svg>
            <span class="plot-of">${name}</span> <output aria-live="off">${value}</output>
          </span>`;
        })}
      </span>
      <span class="plot-time number quiet">${at === null ? "" : timeText(at, 2, span.to)}</span>
      <${SaveButtons} what="plot" kinds=${["png", "svg", "csv"]} save=${save} />
    </figcaption>
    <div ref=${area} class="plot-area" style=${{ height: `${height}px` }}>
      <canvas
        ref=${canvas}
        role="img"
        aria-label="${title}: ${series.map(({ name }) => name).join(", ")}"
        style=${{ height: `${height}px` }}
        onPointerMove=${(event) => (cursor.value = timeOf(event))}
        onPointerLeave=${() => (cursor.value = null)}
      ></canvas>
    </div>
  </figure>`;
}
