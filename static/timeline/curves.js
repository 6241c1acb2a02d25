// The curves that are plotted below the lanes: asked of the run as it goes on, never twice the same.

import { computed, effect, signal } from "../vendor/preact.js";
import { remembered } from "../remembered.js";
import { isLeft, say } from "../server.js";
import { alive, complain, events, running, session, whichRun } from "../store.js";
import { rangeOf } from "../parts/curve.js";
import { furthest } from "./seek.js";

const PAUSE = 400; // between two questions while the run goes on [ms]: to answer costs it time
const AT_ONCE = 150; // so many moments are asked for at a time while it goes on
const MOST = 3000; // and so many for all of a run that stands

/** All curves there are: [{name, unit, group}]. */
export const names = signal([]);
/** Counts the changes of what is known. */
export const curvesVersion = signal(0);
/** What is known: moments [s] and values by name. */
export const known = { times: [], values: new Map() };

const GROUPS = ["joint", "speed", "clearance", "contact", "place", "joint speed"]; // in the order in which they are plotted
const TITLES = { joint: "joints", contact: "contact force", "joint speed": "joint speeds" };

/** What a group of curves is called. */
export function titleOf(group) {
  return TITLES[group] ?? group;
}

const kept = remembered("timeline curves", { names: null });

function usual(all) {
  const joints = all.filter(({ group }) => group === "joint");
  const turns = joints.filter(({ name }) => /(stance|torso)_yaw$/.test(name)); // of people, hips and shoulders
  const plotted = turns.length > 0 ? turns : joints.slice(0, 1);
  return all.filter((curve) => plotted.includes(curve) || curve.group === "speed" || curve.group === "clearance").map(({ name }) => name);
}

/** The names of those that are plotted. */
export const chosen = computed(() => {
  const there = new Set(names.value.map(({ name }) => name));
  const wanted = kept.value.names?.filter((name) => there.has(name));
  return wanted && (wanted.length > 0 || kept.value.names.length === 0) ? wanted : usual(names.value);
});

/** Chooses what is plotted; null for what is usual. */
export function choose(list) {
  kept.value = { names: list };
}

/** The plots: [{title, unit, series}], one for each group of which something is chosen. */
export const plots = computed(() => {
  curvesVersion.value;
  const made = new Map();
  for (const { name, unit, group } of names.value) {
    if (!chosen.value.includes(name)) continue;
    const key = `${group} [${unit}]`;
    if (!made.has(key)) made.set(key, { title: titleOf(group), group, unit, series: [] });
    made.get(key).series.push({ name, unit, values: known.values.get(name) ?? [] });
  }
  const order = ({ group }) => (GROUPS.includes(group) ? GROUPS.indexOf(group) : GROUPS.length);
  const sorted = [...made.values()].sort((one, other) => order(one) - order(other));
  return sorted.map((plot) => ({ ...plot, times: known.times, range: rangeOf(plot.series) }));
});

/** When something touched the body: bands, of the moments that are known. */
export const contacts = computed(() => {
  curvesVersion.value;
  const bands = [];
  for (const { name, group } of names.value) {
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

let asked = ""; // of which run, and for which curves, what is known is
let thinned = false; // whether moments were left out
let busy = false;
let again = false;
let cuts = 0;

function forget(key) {
  asked = key;
  known.times = [];
  known.values = new Map();
  thinned = false;
  curvesVersion.value = curvesVersion.peek() + 1;
}

function take({ times, curves }) {
  known.times.push(...times);
  for (const [name, values] of Object.entries(curves)) {
    if (!known.values.has(name)) known.values.set(name, []);
    known.values.get(name).push(...values);
  }
  curvesVersion.value = curvesVersion.peek() + 1;
}

async function ask() {
  if (running.peek() && document.hidden) return; // nobody looks, and to answer costs the run time
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

/** Tells runs, and ways that a run has gone, from others. */
const whoseNow = () => `${whichRun()} ${cuts}`;

/** Asks for what is not known yet, if there is anything; tells whether there may be more. */
async function askOnce() {
  const { world } = session.peek() ?? {};
  const whose = whoseNow();
  if (!asked.startsWith(`${whose} `)) {
    forget(`${whose} `);
    const told = world ? await say({ type: "curves", names: [] }) : { names: [] };
    if (whose !== whoseNow()) return true;
    names.value = told.names;
  }
  const wanted = names.peek().filter(({ name, group }) => group === "contact" || chosen.peek().includes(name));
  const list = wanted.map(({ name }) => name);
  const key = `${whose} ${JSON.stringify(list)}`;
  if (asked !== key || (thinned && !running.peek())) forget(key);
  const last = known.times.at(-1);
  const end = furthest.peek();
  if (list.length === 0 || (last !== undefined && end <= last + 1e-6)) return false;
  const most = running.peek() && last !== undefined ? AT_ONCE : MOST;
  const period = session.peek()?.period ?? 0.01;
  const told = await say({ type: "curves", names: list, first: last === undefined ? 0 : last + period / 2, most });
  if (asked !== key || whose !== whoseNow()) return true;
  const count = Math.round((end - (last ?? -period)) / period);
  thinned ||= running.peek() && told.times.length < count;
  take(told);
  return running.peek();
}

document.addEventListener("visibilitychange", () => alive.peek() && ask());

effect(() => {
  if (events.value.cut) cuts += 1;
});

effect(() => {
  furthest.value;
  running.value;
  chosen.value;
  session.value;
  events.value.cut;
  if (alive.value) ask();
  else if (!session.value && names.peek().length > 0) names.value = [];
});
