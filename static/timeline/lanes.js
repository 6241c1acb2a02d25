// Lanes made of a run's events as they come: a row for each thing that lasts, with a band for each of its states.

import { chunkText } from "../parts/chunk.js";
import { Widths } from "./commands.js";
import { firstWhere } from "./search.js";
import { TAKERS } from "./takers.js";

/**
 * @typedef Band
 * @property {number} from When it begins [s].
 * @property {number | null} to When it ends [s]; null while it lasts.
 * @property {string} [text] What it says; or else `chunk`, whose text is made when it is first shown.
 * @property {object} [chunk]
 * @property {string} tone The name of a colour.
 * @property {string} [end] How it ended, where that is worth telling.
 */

/** One row. */
class Lane {
  constructor(key, group, label) {
    Object.assign(this, { key, group, label, bands: [] });
  }

  /** The band that lasts, if there is one. */
  get open() {
    const last = this.bands.at(-1);
    return last && last.to === null ? last : null;
  }

  /** Ends the band that lasts. */
  close(time, end = "") {
    const band = this.open;
    if (!band) return;
    band.to = time;
    if (end) band.end = end;
    // What begins and ends at once, to make place for another, is not seen.
    if (band.from === time && !band.mark && !end) this.bands.pop();
  }

  /** Begins a band; the one before it ends. */
  begin(time, band) {
    this.close(time);
    this.bands.push({ from: time, to: null, ...band });
  }

  /** Sets a mark: something that happens at once. */
  mark(time, band) {
    this.bands.push({ from: time, to: time, mark: true, ...band });
  }

  /** Returns the number of the first band that lasts beyond a time. */
  firstAfter(time) {
    return firstWhere(this.bands, (band) => band.to === null || band.to >= time);
  }

  /** Returns the band at a time, or the mark next to it, if there is one; `near` is how far off a mark may be [s]. */
  at(time, near) {
    let found = null;
    for (let n = this.firstAfter(time - near); n < this.bands.length; n += 1) {
      const band = this.bands[n];
      if (band.from > time + near) break;
      const inside = band.from <= time && (band.to === null || time <= band.to);
      if (inside || !found) found = band;
      if (inside && (band.to === null || time < band.to)) break;
    }
    return found;
  }
}

/** Says a band in one line. */
export function bandText(band) {
  band.text ??= chunkText(band.chunk);
  return band.text;
}

/** All lanes of a run. */
export class Lanes {
  constructor() {
    this.clear();
  }

  clear() {
    this.lanes = new Map();
    this.tones = new Map();
    this.clocks = new Map();
    this.asked = new Map();
    this.widths = new Widths();
    this.now = 0;
    this.begin = null;
  }

  /** Returns a lane, made where it is new. */
  lane(key, group, label = key) {
    let lane = this.lanes.get(key);
    if (!lane) this.lanes.set(key, (lane = new Lane(key, group, label)));
    return lane;
  }

  /** Returns the colour of a name: another one for each, as far as there are. */
  tone(name) {
    if (!this.tones.has(name)) this.tones.set(name, `series-${(this.tones.size % 6) + 1}`);
    return this.tones.get(name);
  }

  /** Takes in one event: [time in us, source, kind, data]. */
  take(event) {
    const [time, source, kind, data] = event;
    // Of a program that makes one run after another, each one's time begins anew; on the axis they follow each other.
    const run = source.startsWith("top#") ? source.slice(0, source.indexOf(".") < 0 ? undefined : source.indexOf(".")) : "top";
    const before = this.clocks.get(run) ?? 0;
    if (time > before) {
      this.clocks.set(run, time);
      this.now += time - before;
    }
    const now = this.now / 1e6;
    this.begin ??= now;
    TAKERS[kind]?.(this, now, source, data, event);
  }

  /** Forgets what was over before a time [s]. */
  forget(time) {
    this.begin = time;
    for (const lane of this.lanes.values()) lane.bands.splice(0, lane.firstAfter(time));
  }
}
