// A tooltip for what is at the pointer.

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { valueAt } from "../parts/curve.js";
import { numberText } from "../parts/ticks.js";
import { bandText } from "./lanes.js";
import { furthest, runTimeText } from "./seek.js";

const NEAR = 4; // the maximum distance of a mark from the pointer [px]
const AWAY = 14; // from the pointer [px]
const MAX_CHARACTERS = 1200; // the maximum number of characters

/** Returns what is at a position: {row, time, near, band}. */
export function found(row, time, secondsPerPixel) {
  const near = NEAR * secondsPerPixel;
  return { row, time, near, band: row.lane?.at(time, near) ?? null };
}

function Times({ band }) {
  if (band.mark) return html`<p class="number quiet">at ${runTimeText(band.from, 3)}</p>`;
  const to = band.to === null ? "the newest moment" : runTimeText(band.to, 3);
  const length = band.to === null ? "" : `, ${((band.to - band.from) * 1000).toFixed(0)} ms`;
  return html`<p class="number quiet">${runTimeText(band.from, 3)} to ${to}${length}${band.end ? `, ${band.end}` : ""}</p>`;
}

function OfBand({ row, band }) {
  return html`<p><b>${row.lane.label}</b></p>
    ${bandText(band) ? html`<p class="mono">${bandText(band).slice(0, MAX_CHARACTERS)}</p>` : null}
    ${band.more ? html`<p class="quiet">${String(band.more).slice(0, MAX_CHARACTERS)}</p>` : null}
    <${Times} band=${band} />`;
}

function OfRow({ at }) {
  if (at.row.plot) return html`<${OfPlot} plot=${at.row.plot} time=${at.time} near=${at.near} />`;
  return at.named ? html`<p><b>${at.row.lane.label}</b></p>` : html`<${OfBand} row=${at.row} band=${at.band} />`;
}

function OfPlot({ plot, time, near }) {
  return html`<p><b>${plot.title}</b> <span class="number quiet">at ${runTimeText(time)}</span></p>
    ${plot.series.map((curve) => {
      const { name, unit, colour } = curve;
      const value = numberText(time > furthest.value ? null : valueAt(curve, time, near));
      return html`<p key=${name} class="number"><span class="swatch" style=${{ background: `var(--${colour})` }}></span>${name} ${value} ${unit}</p>`;
    })}`;
}

/** @param at {x, y} of the pointer in the window [px], and the result of `found`, or the `named` row; null for nothing. */
export function Tip({ at }) {
  const box = useRef(null);
  const shown = at && (at.row.plot || at.band || at.named);
  useLayoutEffect(() => {
    if (!shown) return;
    const { offsetWidth: width, offsetHeight: height, style } = box.current;
    style.left = `${at.x + AWAY + width > innerWidth ? Math.max(0, at.x - AWAY - width) : at.x + AWAY}px`;
    style.top = `${Math.max(0, at.y - AWAY - height)}px`;
  });
  if (!shown) return null;
  return html`<div ref=${box} class="timeline-tip" role="tooltip"><${OfRow} at=${at} /></div>`;
}
