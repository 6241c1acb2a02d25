// The curves that are plotted below the lanes: those of bodies, which the server computes, and the numbers of events. While the run is
// active, the newest stretch of the former is requested, coarsely if it is fast; what was omitted is requested when it pauses: first the
// visible stretch, then the rest, until each tick is known.

import { computed, effect, signal } from "../vendor/preact.js";
import { remembered } from "../local_storage.js";
import { isLeft, say } from "../server.js";
import { alive, complain, hurried, running, session, way } from "../store.js";
import { firstFrom, rangeOf } from "../parts/curve.js";
import { lanes, lanesVersion } from "./record.js";
import { furthest } from "./seek.js";
import { span } from "./view.js";

const PAUSE = 400; // between two requests while the run is active [ms]: answering slows it down
const AT_ONCE = 150; // the number of moments per request while it is active
const OVERVIEW = 1500; // the number of moments for a whole run of which nothing is known yet
const PIECE = 1000; // the number of ticks per request when paused: longer stretches would delay commands

/** The curves of bodies: [{name, unit, group}]. */
const ofBodies = signal([]);
/** How many curves of numbers there are. */
const numberCount = computed(() => (lanesVersion.value, lanes.numbers.curves.size));
/** All curves there are: [{name, unit, group, of?}]; `of` is the list in which a curve is offered, if it is not its group. */
export const names = computed(() => (numberCount.value, [...ofBodies.value, ...lanes.numbers.curves.values()]));
/** Counts the changes of what is known. */
export const curvesVersion = signal(0);
/** The known data: moments [s], ascending, values by name, and the stretches [from, to] of which every moment is known. */
export const known = { times: [], values: new Map(), whole: [] };

const GROUPS = ["joint", "speed", "clearance", "contact", "place", "joint speed", "learned utility", "utility", "activation"]; // in the order in which they are plotted
const TITLES = { joint: "joints", contact: "contact force", "joint speed": "joint speeds" };

/** The title of a group of curves. */
export function titleOf(group) {
  return TITLES[group] ?? group;
}

const USUAL = ["speed", "clearance", "learned utility"]; // the groups that are plotted until the user chooses

const MAX_MODELS = 50; // of which choices are remembered
const chosenOf = remembered("timeline curves of models", []);
const model = computed(() => session.value?.model ?? null);

/** The names that the user has chosen for this model; null as long as that is none. */
const kept = computed(() => chosenOf.value.find((one) => one.model === model.value)?.names ?? null);

function keep(names) {
  chosenOf.value = [...chosenOf.newest().filter((one) => one.model !== model.peek()), ...(names === null ? [] : [{ model: model.peek(), names }])].slice(-MAX_MODELS);
}

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
  const others = (kept.value ?? chosen.value).filter((other) => other !== name);
  keep(on ? [...others, name] : others);
}

/** Plots the usual curves. */
export function plotUsual() {
  keep(null);
}

/** The heading of a plot, with its unit if it has one. */
export function headingOf({ title, unit }) {
  return unit ? `${title} [${unit}]` : title;
}

const plotsOfBodies = computed(() => {
  curvesVersion.value;
  return plotsOf(ofBodies.value, ({ name, unit }) => ({ name, unit, times: known.times, values: known.values.get(name) ?? [] }));
});

/** The same for numbers of events, which are drawn again with each event. */
const plotsOfNumbers = computed(() => {
  lanesVersion.value;
  const until = furthest.value;
  return plotsOf(lanes.numbers.curves.values(), (curve) => ({ ...curve, name: curve.title, range: curve.rangeUntil(until) }));
});

/** Returns one plot for each group and unit of chosen curves. */
function plotsOf(curves, seriesOf) {
  const wanted = new Set(chosen.value);
  const made = new Map();
  for (const curve of curves) {
    const { name, unit, group } = curve;
    if (!wanted.has(name)) continue;
    const key = `${group} [${unit}]`;
    if (!made.has(key)) made.set(key, { title: titleOf(group), group, unit, series: [] });
    made.get(key).series.push(seriesOf(curve));
  }
  return [...made.values()].map((plot) => ({ ...plot, range: rangeOf(plot.series) }));
}

/** The plots: [{title, unit, series, range}], one for each group with chosen curves. */
export const plots = computed(() => {
  const order = ({ group }) => (GROUPS.includes(group) ? GROUPS.indexOf(group) : GROUPS.length);
  return [...plotsOfBodies.value, ...plotsOfNumbers.value].sort((one, other) => order(one) - order(other));
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

let asked = ""; // the history, the run and the curves of the known data
let busy = false;
let again = false;
let newer = false; // whether the newest stretch was requested last, while the run is active

const near = () => (session.peek()?.period || 0.01) / 2; // moments that are no farther apart count as the same [s]

function forget(key) {
  asked = key;
  Object.assign(known, { times: [], values: new Map(), whole: [] });
  curvesVersion.value = curvesVersion.peek() + 1;
}

/** Replaces the known data of a stretch by new data. */
function put(names, { from, to, whole }, { times, curves }) {
  const [begin, end] = [firstFrom(known.times, from - near()), firstFrom(known.times, to + near())];
  const placed = (list, news) => [...list.slice(0, begin), ...news, ...list.slice(end)];
  for (const name of names) known.values.set(name, placed(known.values.get(name) ?? [], curves[name] ?? times.map(() => null)));
  known.times = placed(known.times, times);
  if (whole) known.whole = joined([...known.whole, [from, to]]);
  curvesVersion.value = curvesVersion.peek() + 1;
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

/** Returns the first stretch with omitted moments between two moments; null if there is none. */
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

/** Returns the next stretch to request, {from, to, most, whole}; null if everything needed now is known. */
function next() {
  const end = furthest.peek();
  const tick = session.peek()?.period || 0.01;
  const last = known.times.at(-1);
  const newest = (from, most) => ({ from, to: end, most, whole: (end - from) / tick < most - 2 });
  if (last === undefined) return newest(0, OVERVIEW);
  const { from, to } = span.peek();
  const missing = hurried.peek() ? null : (gap(Math.max(0, from), Math.min(to, end)) ?? gap(0, end));
  // While the run is active there is always new data: requests alternate between it and what was omitted.
  newer = running.peek() && (!newer || !missing);
  if (newer) return end > last + near() ? newest(last, AT_ONCE) : null;
  const ticks = running.peek() ? AT_ONCE : PIECE;
  return missing && { from: missing.from, to: Math.min(missing.to, missing.from + ticks * tick), most: ticks + 3, whole: true };
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
    if (alive.peek() && !isLeft(error)) complain(`the curves: ${error.message}`);
    again = isLeft(error);
  }
  setTimeout(() => {
    busy = false;
    if (again) ask();
  }, running.peek() ? PAUSE : 0);
}

/** Requests missing data, if any; returns whether there may be more. Ignores data of another history. */
async function askOnce() {
  const { world } = session.peek() ?? {};
  const whose = `${way.peek()} ${Boolean(world)}`; // a program may create its world later
  if (!asked.startsWith(`${whose} `)) {
    forget(`${whose} `);
    const answer = world ? await say({ type: "curves", names: [] }) : { names: [] };
    if (!whose.startsWith(`${way.peek()} `)) return true;
    ofBodies.value = answer.names;
  }
  const list = ofBodies.peek().map(({ name, group }) => (group === "contact" || chosen.peek().includes(name) ? name : null)).filter(Boolean);
  const key = `${whose} ${JSON.stringify(list)}`;
  if (asked !== key) forget(key);
  const stretch = list.length > 0 ? next() : null;
  if (!stretch) return false;
  const answer = await say({ type: "curves", names: list, first: Math.max(0, stretch.from - near()), last: stretch.to + near(), most: stretch.most });
  if (asked !== key || !whose.startsWith(`${way.peek()} `)) return true;
  if (answer.names.length !== ofBodies.peek().length) ofBodies.value = answer.names; // another world was added
  put(list, stretch, answer);
  return known.times.length > 0;
}

document.addEventListener("visibilitychange", () => alive.peek() && ask());

effect(() => {
  for (const one of [furthest, running, chosen, session, way, span]) one.value;
  if (alive.value) ask();
  else if (!session.value && ofBodies.peek().length > 0) ofBodies.value = [];
});
