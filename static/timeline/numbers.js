// The numbers that events of a run report, as curves: slots of buffers, attributes of modules, utilities, activations, latencies, and
// how long modules were busy and buffers full.

import { partName } from "../inspector/part_names.js";
import { firstFrom } from "../parts/curve.js";
import { timeText } from "../parts/ticks.js";

const MAX_CURVES = 5000; // the maximum number of curves
const NUMBER = /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i;

/** Returns a value as a number, also if it is written as text; null if it is none. */
function numberOf(value) {
  if (typeof value === "number") return Number.isFinite(value) ? value : null;
  return typeof value === "string" && NUMBER.test(value) ? Number(value) : null;
}

/** One curve, as `drawCurves` draws it: with `steps`, each value holds until the next one; with `slope`, the last one goes on. `since` is
 * when its sum begins [s], if it is not the sum of the whole run. */
class NumberCurve {
  constructor(name, unit, group, of) {
    Object.assign(this, { name, unit, group, of, times: [], values: [], least: Infinity, most: -Infinity, steps: false, slope: undefined, since: null });
  }

  /** Adds a value; null if there is none from now on. Of several at one moment, the last one counts. */
  add(time, value) {
    const last = this.times.length - 1;
    if (last >= 0 && this.times[last] === time) this.values[last] = value;
    else {
      this.times.push(time);
      this.values.push(value);
    }
    if (value === null) return;
    this.least = Math.min(this.least, value);
    this.most = Math.max(this.most, value);
  }

  /** The name with the time at which its sum begins, if that is not the beginning of the run. */
  get title() {
    return this.since === null ? this.name : `${this.name} since ${timeText(this.since, 0.001)}`;
  }

  /** Returns the least and the greatest value until a time [s]. */
  rangeUntil(time) {
    const grown = this.slope && this.values.length ? this.values.at(-1) + this.slope * (time - this.times.at(-1)) : this.most;
    return [this.least, Math.max(this.most, grown)];
  }
}

/** All curves of numbers of a run; `whole` if its events are known from the first one on. */
export class Numbers {
  constructor(whole) {
    this.whole = whole;
    this.curves = new Map();
    this.slots = new Map(); // by buffer: its slots with numbers
    this.firsts = new Map(); // by attribute: its first number
  }

  /** Returns a curve, and creates it if it is new; null if there are too many. `of` is the list it belongs to. */
  curve(name, unit, group, of = group) {
    let curve = this.curves.get(name);
    if (!curve && this.curves.size < MAX_CURVES) this.curves.set(name, (curve = new NumberCurve(name, unit, group, of)));
    return curve ?? null;
  }

  /** Adds a value of a single moment. */
  point(time, value, ...what) {
    const number = numberOf(value);
    if (number !== null) this.curve(...what)?.add(time, number);
  }

  /** Adds a value that holds until the next one of its curve. */
  hold(time, value, ...what) {
    const curve = this.curve(...what);
    if (!curve) return;
    Object.assign(curve, { steps: true, slope: 0 });
    if (curve.values.at(-1) !== value) curve.add(time, value);
  }

  /** Adds up how long something lasts: from the first event about it, as what was before is not known unless the run is `whole`. */
  last(time, on, ...what) {
    const curve = this.curve(...what);
    if (!curve || curve.slope === Number(on)) return;
    if (curve.slope === undefined && !this.whole) curve.since = time;
    const before = curve.slope === 1 ? curve.values.at(-1) + time - curve.times.at(-1) : (curve.values.at(-1) ?? 0);
    curve.add(time, before);
    curve.slope = Number(on);
  }

  /** Removes what was before a time [s], except the values that still hold then. */
  forget(time) {
    for (const { times, values, slope } of this.curves.values()) {
      const first = Math.max(0, firstFrom(times, time) - (slope === undefined ? 0 : 1));
      times.splice(0, first);
      values.splice(0, first);
    }
  }

  /** Adds what an event reports, at a time of the axis [s]. */
  take(time, source, kind, data) {
    TAKERS[kind]?.(this, time, source, data);
  }
}

/** The slots of a buffer's chunk that hold numbers; those of another chunk end. */
function buffer(numbers, time, source, { chunk }) {
  numbers.last(time, Boolean(chunk), `${source} full`, "s", "time full");
  const before = numbers.slots.get(source) ?? new Set();
  const now = new Set();
  for (const [slot, text] of Object.entries(chunk ?? {})) {
    const value = numberOf(text);
    if (value === null) continue;
    now.add(slot);
    numbers.hold(time, value, `${source}.${slot}`, "", slot, source);
  }
  for (const slot of before.difference(now)) numbers.hold(time, null, `${source}.${slot}`, "", slot, source);
  numbers.slots.set(source, now);
}

/** The attributes that change; most are settings, and stay as they are. */
function state(numbers, time, source, data) {
  for (const [name, value] of Object.entries(data)) {
    const [curve, number] = [`${source}.${name}`, numberOf(value)];
    const first = numbers.firsts.get(curve);
    if (first === undefined && number !== null) numbers.firsts.set(curve, { time, number });
    if (first === undefined || first.number === number) continue;
    if (!numbers.curves.has(curve)) numbers.hold(first.time, first.number, curve, "", name, source);
    numbers.hold(time, number, curve, "", name, source);
  }
  if (typeof data.busy === "boolean") numbers.last(time, data.busy, `${source} busy`, "s", "time busy");
}

/** Returns the path of a production: like the paths of parts, without the name of the model if it is the first `top`. */
function pathOf(system, production) {
  return system === "top" ? production : `${system}.${production}`;
}

function conflict(numbers, time, source, { utilities }) {
  for (const [production, value] of Object.entries(utilities)) numbers.point(time, value, `${pathOf(source, production)} utility`, "", "utility");
}

function utility(numbers, time, source, { production, part, value }) {
  const number = numberOf(value);
  if (number !== null) numbers.hold(time, number, `${pathOf(source, production)} learned ${part}`, "", `learned ${part}`);
}

/** What a memory has found: the activations of the candidates with their parts, and how long the retrieval takes. */
function request(numbers, time, source, { candidates, modules, latency }) {
  if (!candidates) return;
  for (const [chunk, parts, , activation] of candidates) {
    numbers.point(time, activation, `${source}: ${chunk} activation`, "", "activation");
    if (modules.length !== parts.length) continue;
    parts.forEach((part, n) => numbers.point(time, part, `${source}: ${chunk} ${partName(modules[n])}`, "", partName(modules[n])));
  }
  numbers.point(time, latency, `${source} latency`, "s", "retrieval latency");
}

/** By the kind of the event: the function that adds its numbers. */
const TAKERS = { buffer, state, conflict, utility, request };
