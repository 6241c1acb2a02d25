// The curves that are plotted below the lanes, which the worker computes: those of bodies, with a value at each tick, and those of events,
// each with its own times. While the run is active, the newest stretch is requested, coarsely if it is fast; what was omitted is requested
// when it pauses: first the visible stretch, then the rest, until every value or a great many are known.

import { computed, effect, signal } from "../vendor/preact.js";
import { rememberedByModel } from "../model_storage.js";
import { isLeft, request } from "../server.js";
import { alive, eventCount, history, hurried, notify, period, running, session } from "../store.js";
import { leastAndMost, rangeOf, replace } from "../parts/curve.js";
import { firstFrom } from "../parts/search.js";
import { exactTime, nameWithUnit } from "../parts/units.js";
import { subjectOf, subjectsOf, withColours } from "./colours.js";
import { lanes } from "./record.js";
import { furthest } from "./seek.js";
import { span } from "./view.js";

const PAUSE = 400; // between two requests while the run is active [ms]: answering slows it down
const AT_ONCE = 150; // the number of moments per request while it is active
const OVERVIEW = 1500; // the number of moments for a whole run of which nothing is known yet
const PIECE = 1000; // the number of ticks per request when paused: longer stretches would delay commands
const MAX_VALUES = 5000; // the maximum number of values of a curve per request
const MAX_KNOWN = 1_000_000; // from so many known values on, only what is missing in a short visible stretch is requested
const SHORT = 100_000; // the number of ticks of the longest of these
const NOTHING = { times: [], values: [], slope: null };
const CHUNKS = "activation over time";
const OF_CHUNK = /^(.*?): (.*) ((activation|base level|spreading|fixed|inhibition)( \d+)?( without noise)?) over time$/s; // the names of curves of chunks, as `workbench/chunk_curves.py` has them
const DASHES = { "base level": [6, 3], spreading: [2, 2], fixed: [8, 2, 2, 2], inhibition: [10, 4] }; // of the parts of activation: each is drawn in the colour of its chunk

/** The curves of bodies: [{name, unit, group, of, shape}], where `of` is the list in which a curve is offered, if it is not its group. */
const ofBodies = signal([]);
/** The same for those of events, as far as the page has asked for them. */
const ofEvents = signal([]);
/** Those of chunks over time, which the worker computes from the events if asked for: those that were chosen, and those of the chunks that
 * were candidates of a retrieval. */
const ofChunks = computed(() => {
  const found = new Set((kept.value ?? []).filter(isOfChunk));
  const all = new Set(ofEvents.value.map(({ name }) => name));
  for (const { name, group, shape } of ofEvents.value) {
    const noisy = group === "activation" && all.has(name.replace(/activation$/, "noise"));
    const overTime = `${name}${noisy ? " without noise" : ""} over time`;
    if (shape === "points" && isOfChunk(overTime)) found.add(overTime);
  }
  return [...found].map((name) => ({ name, unit: "", group: CHUNKS, of: null, shape: "line" }));
});
/** All curves that are known. */
export const names = computed(() => [...ofBodies.value, ...ofEvents.value, ...ofChunks.value]);

/** Returns the parts of the name of a curve of a chunk over time, {memory, chunk, part, kind, number}, with the kind of the part and its number
 * among parts of this kind; null for other names. */
export function chunkCurve(name) {
  const [, memory, chunk, part, kind, number] = OF_CHUNK.exec(name) ?? [];
  return memory === undefined ? null : { memory, chunk, part, kind, number: Number(number ?? 1) };
}

/** Returns the dashes of the curve of a chunk over time; of several parts of one kind, the second has dashes twice as long, and so on. */
function dashOf(name) {
  const { kind, number } = chunkCurve(name);
  return DASHES[kind]?.map((length) => length * number);
}

/** Returns what a curve is about; for that of a chunk over time, the same as for its values at retrievals. */
function subject(curve) {
  const of = curve.group === CHUNKS ? chunkCurve(curve.name) : null;
  return of ? `${of.memory}: ${of.chunk}` : subjectOf(curve);
}

/** What is known of the subjects of all curves. */
const subjects = computed(() => subjectsOf(names.value.map((curve) => ({ subject: subject(curve), group: curve.group }))));
/** The subjects of plotted curves. */
const plotted = computed(() => {
  const wanted = new Set(chosen.value);
  return new Set(names.value.filter(({ name }) => wanted.has(name)).map(subject));
});

/** The colours of subjects as [subject, colour], remembered for the model: after a reload they are the same. */
const { kept: keptColours, keep: keepColours } = rememberedByModel("curve colours of models", "colours");
/** The colours of subjects of which a curve was plotted. */
const colours = computed(() => withColours(keptColours.value, subjects.value, plotted.value, (subject) => lanes.tones.get(subject.split(".").at(-1))));

/** Returns the colour of what curves are about, such as a production; undefined if none of its curves was plotted. */
export function colourOf(subject) {
  return colours.value.get(subject);
}

/** Whether the curves are offered to the user. */
export const offered = signal(false);
/** Counts the changes of what is known. */
export const curvesVersion = signal(0);
/** The known data: of bodies, moments [s], ascending, and values by name; of events, by name `{times, values, slope, why}`; `until` when
 * [s] they are known, at least coarsely (null for not at all), and the stretches [from, to] of which every value is known. */
export const known = { times: [], values: new Map(), events: new Map(), until: null, whole: [] };

const GROUPS = ["joint", "speed", "clearance", "contact", "place", "joint speed", "learned utility", "utility", CHUNKS, "activation"]; // in the order in which they are plotted
const TITLES = { joint: "joints", contact: "contact force", "joint speed": "joint speeds" };

/** The title of a group of curves. */
export function titleOf(group) {
  return TITLES[group] ?? group;
}

const USUAL = ["speed", "clearance", "learned utility"]; // the groups that are plotted until the user chooses

/** The names that the user has chosen for this model; null as long as that is none. */
const { kept, keep } = rememberedByModel("timeline curves of models", "names");

function usual(all) {
  const joints = all.filter(({ group }) => group === "joint");
  const turns = joints.filter(({ name }) => /(stance|torso)_yaw$/.test(name)); // for people: hips and shoulders
  const plotted = turns.length > 0 ? turns : joints.slice(0, 1);
  return all.filter((curve) => plotted.includes(curve) || USUAL.includes(curve.of ?? curve.group)).map(({ name }) => name);
}

/** The names of the plotted curves. */
export const chosen = computed(() => {
  const there = new Set(names.value.map(({ name }) => name));
  const wanted = kept.value?.filter((name) => there.has(name));
  return wanted && (wanted.length > 0 || kept.value.length === 0) ? wanted : usual(names.value);
});

/** Plots a curve, or no longer. */
export function plot(name, on) {
  plotAll([name], on);
}

/** Plots several curves, or no longer. */
export function plotAll(names, on) {
  const others = (kept.value ?? chosen.value).filter((other) => !names.includes(other));
  keep(on ? [...others, ...names] : others);
}

export function plotUsual() {
  keep(null);
}

/** The heading of a plot, with its unit if it has one. */
export function headingOf({ title, unit }) {
  return nameWithUnit(title, unit);
}

const plotsOfBodies = computed(() => {
  curvesVersion.value;
  return plotsOf(ofBodies.value, ({ name, unit }) => ({ name, unit, times: known.times, values: known.values.get(name) ?? [] }));
});

/** The same for those of events, some of which go on until the newest moment. */
const plotsOfEvents = computed(() => {
  curvesVersion.value;
  const until = furthest.value;
  return plotsOf([...ofEvents.value, ...ofChunks.value], ({ name, unit, shape }) => {
    const { times, values, slope } = known.events.get(name) ?? NOTHING;
    const [least, most] = leastAndMost(values);
    const grown = slope && values.length ? values.at(-1) + slope * (until - times.at(-1)) : -Infinity;
    return { name, unit, times, values, shape, slope: slope ?? undefined, range: [least, Math.max(most, grown)] };
  });
});

/** Returns one plot for each group and unit of chosen curves, in which subjects have the same order as in other plots. */
function plotsOf(curves, seriesOf) {
  const wanted = new Set(chosen.value);
  const known = subjects.value;
  const shown = curves.filter(({ name }) => wanted.has(name)).map((curve) => ({ curve, of: subject(curve) }));
  const made = new Map();
  for (const { curve, of } of shown.sort((one, other) => known.get(one.of).place - known.get(other.of).place)) {
    const { name, unit, group } = curve;
    const key = `${group} [${unit}]`;
    if (!made.has(key)) made.set(key, { title: titleOf(group), group, unit, series: [] });
    made.get(key).series.push({ ...seriesOf(curve), colour: colourOf(of), dash: group === CHUNKS ? dashOf(name) : undefined });
  }
  return [...made.values()].map((plot) => ({ ...plot, title: onlyChunk(plot) ?? plot.title, range: rangeOf(plot.series) }));
}

/** Returns the title of a plot that shows a single chunk over time: `item:cup over time`; null for any other plot. */
function onlyChunk({ group, series }) {
  if (group !== CHUNKS) return null;
  const chunks = new Set(series.map(({ name }) => chunkCurve(name).chunk));
  return chunks.size === 1 ? `${[...chunks][0]} over time` : null;
}

/** The plots: [{title, group, unit, series, range}], one for each group with chosen curves. */
export const plots = computed(() => {
  const order = ({ group }) => (GROUPS.includes(group) ? GROUPS.indexOf(group) : GROUPS.length);
  return [...plotsOfBodies.value, ...plotsOfEvents.value].sort((one, other) => order(one) - order(other));
});

/** The times of contact with the body: bands, from the known moments. */
export const contacts = computed(() => {
  curvesVersion.value;
  const bands = [];
  for (const { name, group } of ofBodies.value) {
    if (group !== "contact") continue;
    let open = null;
    let hardest = 0;
    (known.values.get(name) ?? []).forEach((force, n) => {
      if (force > 0) {
        if (!open) bands.push((open = { from: known.times[Math.max(0, n - 1)], begins: known.times[n], body: name.replace(/ contact force$/, ""), to: null, tone: "bad" }));
        hardest = open.to === null ? force : Math.max(hardest, force);
        Object.assign(open, { to: known.times[n], hardest, text: `${hardest.toFixed(0)} N`, more: `hardest touch of ${open.body}` });
      } else open = null;
    });
  }
  return bands.sort((one, other) => one.from - other.from);
});

let of = null; // the history of the known data
let named = null; // the history whose curves are named
let key = ""; // the curves of the known data
let basis = ""; // the parameters with which curves of chunks were computed
let counted = -1; // the number of events at the last request that wanted curves of events
let piece = PIECE; // the number of ticks of the next request when paused
let busy = false;
let again = false;
let newer = false; // whether the newest stretch was requested last, while the run is active

/** What known data belongs to: the history of the run, and whether there is a world, as a program may create one later. */
const dataKey = () => `${history.peek()} ${Boolean(session.peek()?.world)}`;

const near = () => period.peek() / 2; // moments that are no farther apart count as the same [s]

function changed() {
  curvesVersion.value = curvesVersion.peek() + 1;
}

/** Removes everything, as the run continues differently, or another one is shown. */
function forget(whose) {
  of = whose;
  key = "";
  counted = -1;
  Object.assign(known, { times: [], values: new Map(), events: new Map(), until: null, whole: [] });
  changed();
}

/** Requests everything again for other curves; what is known of them is drawn until then. */
function begin(list) {
  key = list.join("\n");
  Object.assign(known, { until: null, whole: [] });
  for (const all of [known.values, known.events]) for (const name of [...all.keys()]) if (!list.includes(name)) all.delete(name);
  changed();
}

/** Replaces the known data of a stretch by new data. */
function put(list, { from, to, first, last, whole }, { times, curves, events }) {
  const [low, high] = [firstFrom(known.times, from - near()), firstFrom(known.times, to + near())];
  for (const name of list) {
    if (events[name]) known.events.set(name, withNews(known.events.get(name), events[name], first, last));
    else if (isOfBody(name)) {
      if (!known.values.has(name)) known.values.set(name, []);
      replace(known.values.get(name), low, high, curves[name] ?? times.map(() => null));
    }
  }
  replace(known.times, low, high, times);
  known.until = Math.max(known.until ?? 0, to);
  if (whole) known.whole = joined([...known.whole, [from, to]]);
  changed();
}

/** Returns a curve of events with the new data of a stretch. */
function withNews({ times, values } = { times: [], values: [] }, news, first, last) {
  const [low, high] = [firstFrom(times, first), firstFrom(times, last + 5e-7)];
  replace(times, low, high, news.times);
  replace(values, low, high, news.values);
  return { times, values, slope: news.slope, why: news.why };
}

/** Returns how many values are known. */
function size() {
  return [...known.values.values(), ...known.events.values().map(({ values }) => values)].reduce((sum, { length }) => sum + length, 0);
}

/** Joins stretches that overlap or follow each other. */
function joined(stretches) {
  const found = [];
  for (const [from, to] of stretches.toSorted(([one], [other]) => one - other)) {
    const last = found.at(-1);
    if (last && from <= last[1] + near()) last[1] = Math.max(last[1], to);
    else found.push([from, to]);
  }
  return found;
}

/** Returns the first stretch with omitted values between two moments; null if there is none. */
function gap(begin, end) {
  let from = begin;
  for (const [first, last] of known.whole) {
    if (first > from + near()) break;
    from = Math.max(from, last);
  }
  if (from > end - near()) return null;
  const beyond = known.whole.find(([first]) => first > from)?.[0] ?? end;
  return { from, to: Math.min(beyond, end) };
}

/** Whether a curve is that of a chunk over time. */
export function isOfChunk(name) {
  return OF_CHUNK.test(name);
}

/** Why curves of chunks cannot be computed: sentences, each once. */
export const notComputed = computed(() => {
  curvesVersion.value;
  return [...new Set(chosen.value.map((name) => known.events.get(name)?.why).filter(Boolean))];
});

function isOfBody(name) {
  return ofBodies.peek().some((curve) => curve.name === name);
}

/** Whether curves of events are needed now: while the run is active, only if they are plotted or offered, as computing them takes time. */
function needsEvents() {
  if (!running.peek() || offered.peek()) return true;
  if (kept.peek() === null && lanes.learns) return true; // learned utilities are usual curves
  return (kept.peek() ?? chosen.peek()).some((name) => !isOfBody(name));
}

/** Returns the next stretch to request, {from, to, most, whole}; null if everything needed now is known. */
function next(list) {
  const end = furthest.peek();
  const tick = period.peek();
  const bodies = list.some(isOfBody);
  const newest = (from, most) => ({ from, to: end, most, whole: !bodies || (end - from) / tick < most - 2 });
  if (known.until === null) return newest(0, OVERVIEW);
  const { from, to } = span.peek();
  const many = size() >= MAX_KNOWN;
  const visible = many && (to - from) / tick > SHORT ? null : gap(Math.max(0, from), Math.min(to, end));
  const missing = hurried.peek() ? null : visible ?? (many ? null : gap(0, end));
  // While the run is active there is always new data: requests alternate between it and what was omitted.
  newer = running.peek() && (!newer || !missing);
  if (newer) return end > known.until + near() ? newest(known.until, AT_ONCE) : null;
  if (!missing) return null;
  const ticks = running.peek() ? Math.min(AT_ONCE, piece) : bodies ? Math.min(PIECE, piece) : piece;
  return { from: missing.from, to: Math.min(missing.to, missing.from + ticks * tick), most: MAX_VALUES, whole: true, ticks };
}

async function ask() {
  if (running.peek() && document.hidden) return; // the page is hidden, and answering slows the run down
  if (busy) {
    again = true;
    return;
  }
  busy = true;
  again = false;
  try {
    again = (await askOnce()) || again;
  } catch (error) {
    if (alive.peek() && !isLeft(error)) notify(`the curves: ${error.message}`);
    again = isLeft(error);
  }
  setTimeout(() => {
    busy = false;
    if (again) ask();
  }, running.peek() ? PAUSE : 0);
}

/** Requests missing data, if any; returns whether there may be more. Ignores data of another history. */
async function askOnce() {
  const asked = dataKey();
  if (of !== asked) forget(asked);
  const isNew = named !== asked;
  const events = needsEvents();
  const list = isNew ? [] : names.peek().map(({ name, group }) => (group === "contact" || chosen.peek().includes(name) ? name : null)).filter(Boolean);
  if (key !== list.join("\n")) begin(list);
  const mine = key;
  const now = furthest.peek();
  const count = eventCount.peek();
  // Events may have been added at the newest moment itself, and curves that the page does not know.
  const stretch = (list.length > 0 ? next(list) : null) ?? (isNew || (events && counted !== count) ? { from: now, to: now, most: AT_ONCE, whole: false } : null);
  if (!stretch) return false;
  Object.assign(stretch, { first: exactTime(Math.max(0, stretch.from - near())), last: exactTime(stretch.to + near()) });
  const seen = !events ? null : isNew ? 0 : ofEvents.peek().length;
  const answer = await request({ type: "curves", names: list, first: stretch.first, last: stretch.last, most: stretch.most, seen });
  if (of !== asked || !asked.startsWith(`${history.peek()} `)) return true;
  const [bodies, more] = [true, false].map((isBody) => answer.names.filter(({ shape }) => (shape === "line") === isBody));
  if (isNew || bodies.length !== ofBodies.peek().length) ofBodies.value = bodies; // another world was added
  if (isNew || more.length > 0) ofEvents.value = isNew ? more : [...ofEvents.peek(), ...more];
  named = asked;
  if (events) counted = count;
  if (events && basis !== answer.basis) {
    basis = answer.basis;
    if (list.some(isOfChunk)) begin(list); // what is known of chunks is no longer valid
    return true;
  }
  if (key !== mine || list.length === 0) return key !== mine || more.length > 0 || isNew;
  const isWhole = Object.values(answer.events).every(({ whole }) => whole);
  if (stretch.ticks) piece = isWhole ? Math.max(PIECE, 2 * stretch.ticks) : Math.max(1, Math.floor(stretch.ticks / 2));
  put(list, { ...stretch, whole: stretch.whole && (isWhole || stretch.ticks === 1) }, answer);
  return true;
}

document.addEventListener("visibilitychange", () => alive.peek() && ask());

effect(() => {
  if (session.value && colours.value.size > (keptColours.value?.length ?? 0)) keepColours([...colours.value]);
});

effect(() => {
  for (const one of [furthest, running, chosen, session, history, span, offered, eventCount]) one.value;
  if (alive.value) ask();
  else if (of !== null && (!session.value || of !== dataKey())) {
    forget(null);
    named = null;
    for (const known of [ofBodies, ofEvents]) known.value = [];
  }
});
