// Lanes made of a run's events as they arrive: a row for each thing with states, with a band for each state.

import { runOf } from "../inspector/agents.js";
import { chunkText } from "../parts/chunk.js";
import { seriesColour } from "../parts/curve.js";
import { ReplacedValues } from "./commands.js";
import { firstWhere } from "../parts/search.js";
import { TAKERS } from "./lane_builders.js";

/**
 * @typedef Band
 * @property {number} from Its start [s].
 * @property {number | null} to Its end [s]; null while it is open.
 * @property {string} [text] Its text; or else `chunk`, whose text is made when it is first shown.
 * @property {object} [chunk]
 * @property {string} tone The name of a colour.
 * @property {string} [subject] What curves may be about, too: then the band has their colour.
 * @property {string} [end] How it ended, if this is worth showing.
 */

/** One row. */
class Lane {
  constructor(key, group, label) {
    Object.assign(this, { key, group, label, bands: [] });
  }

  /** The open band, if there is one. */
  get open() {
    const last = this.bands.at(-1);
    return last && last.to === null ? last : null;
  }

  /** Ends the open band. */
  close(time, end = "") {
    const band = this.open;
    if (!band) return;
    band.to = time;
    if (end) band.end = end;
    // A band that begins and ends at the same time is removed.
    if (band.from === time && !band.mark && !end) this.bands.pop();
  }

  /** Ends the open band, because its run has stopped; `resume` continues it if the run goes on. */
  suspend(time) {
    const band = this.open;
    if (!band) return;
    const { from, to, ...rest } = band;
    band.to = time;
    this.suspended = rest;
  }

  resume(time) {
    if (this.suspended) this.begin(time, this.suspended);
  }

  /** Starts a band; the previous one ends. */
  begin(time, band) {
    this.suspended = null;
    this.close(time);
    this.bands.push({ from: time, to: null, ...band });
  }

  /** Adds a mark: an event without duration. */
  mark(time, band) {
    this.bands.push({ from: time, to: time, mark: true, ...band });
  }

  /** Returns the index of the first band that ends after a time. */
  firstAfter(time) {
    return firstWhere(this.bands, (band) => band.to === null || band.to >= time);
  }

  /** Returns the band at a time, or the nearest mark, if there is one; `near` is the maximum distance of a mark [s]. */
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

/** Returns a band as one line of text. */
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
    this.tones = new Map(); // the names of colours by name
    this.asked = new Map();
    this.former = new ReplacedValues();
    this.learns = false; // whether utilities are learned
    this.now = 0;
    this.begin = null;
  }

  /** Returns a lane, and creates it if it is new. */
  lane(key, group, label = key) {
    let lane = this.lanes.get(key);
    if (!lane) this.lanes.set(key, (lane = new Lane(key, group, label)));
    return lane;
  }

  /** Returns the lanes of one run of a program. */
  ofRun(source) {
    const run = runOf(source);
    return [...this.lanes.values()].filter(({ key }) => runOf(key.slice(key.indexOf(" ") + 1)) === run);
  }

  /** Returns the colour of a name: different for each, as far as there are enough. */
  tone(name) {
    if (!this.tones.has(name)) this.tones.set(name, seriesColour(this.tones.size));
    return this.tones.get(name);
  }

  /** Adds one event: [time in us, source, kind, data]. */
  take(event) {
    const [time, source, kind, data] = event;
    this.now = Math.max(this.now, time);
    const now = this.now / 1e6;
    this.begin ??= now;
    TAKERS[kind]?.(this, now, source, data, event);
  }

  /** Removes what was over before a time [s]. */
  forget(time) {
    this.begin = time;
    for (const lane of this.lanes.values()) lane.bands.splice(0, lane.firstAfter(time));
  }
}
