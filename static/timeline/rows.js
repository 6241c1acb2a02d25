// The rows of the timeline, their order and their heights.

import { computed, signal } from "../vendor/preact.js";
import { remembered } from "../local_storage.js";
import { hasScene } from "../store.js";
import { contacts, headingOf, names, plots } from "./curves.js";
import { lanes } from "./record.js";

export const AXIS = 20; // [px]; panels/timeline.css has the same
const LANE = 16;
/** The height of a plot without the names of its curves, and that of a name [px]. */
export const [PLOT, NAME] = [20, 13];
const HEIGHTS = [PLOT + NAME, 500]; // the limits of the height of a plot [px]
const USUAL = [2, 6]; // a plot that nobody has resized has room for the names of its curves; the minimum and maximum number of them
/** The distance of the earliest visible time from the column of names, so that what is at it is drawn whole [px]. */
export const MARGIN = 8;
const GAP = 5; // between two groups

/** The groups in their order. */
const GROUPS = [
  { id: "marks", text: "Marks", title: "What was printed, what users changed, contacts, rewards" },
  { id: "plan", text: "SGOMS", title: "Planning units, unit tasks, methods and operators" },
  { id: "productions", text: "Productions", title: "From when a production is chosen to when it fires" },
  { id: "curves", text: "Curves", title: "Joint angles, speed, clearance and other curves" },
  { id: "buffers", text: "Buffers", title: "What each buffer holds" },
  { id: "modules", text: "Modules", title: "When modules and muscles are busy, and errors" },
];

/** The hidden groups. */
export const hidden = remembered("timeline hidden", []);
/** The width that the user has chosen for the column of names [px]; 0 for none. */
export const chosenColumn = remembered("timeline names", 0);
/** The width of the column of names [px]: without a world, the names of curves are longer. */
export const column = computed(() => chosenColumn.value || (hasScene.value ? 200 : 240));
/** The names of the visible lanes and plots. */
export const filter = signal("");
/** The scroll position of the rows [px]. */
export const scroll = signal(0);
/** The heights of the plots that the user has resized, by heading [px]. */
export const heights = remembered("plot heights", {});

/** Returns the height of a plot [px]. */
function heightOf(plot) {
  return heights.value[headingOf(plot)] ?? PLOT + NAME * Math.min(Math.max(plot.series.length, USUAL[0]), USUAL[1]);
}

/** Sets the height of a plot [px], within limits. */
export function resize(plot, height) {
  heights.value = { ...heights.newest(), [headingOf(plot)]: Math.round(Math.min(Math.max(height, HEIGHTS[0]), HEIGHTS[1])) };
}

/** Makes all plots taller by a number of names; shorter if it is negative. */
export function grow(by) {
  for (const plot of plots.peek()) resize(plot, heightOf(plot) + by * NAME);
}

/** Returns the row of the plot whose lower border is at a height of the stage, up to a distance [px]; undefined if there is none. */
export function plotEndingAt(y, near) {
  return layout(filter.peek()).rows.find((row) => row.plot && Math.abs(row.y + row.height - scroll.peek() - y) <= near);
}

/** The groups that are not empty. */
export function groupsThere() {
  const there = new Set([...lanes.lanes.values()].map(({ group }) => group));
  if (names.value.length > 0) there.add("curves");
  return GROUPS.filter(({ id }) => there.has(id));
}

/** The common prefix of the labels of all lanes, such as the only agent's name; it is omitted. */
function commonStart(list) {
  const paths = list.filter(({ group }) => group === "buffers" || group === "modules" || group === "plan").map(({ label }) => label);
  const start = paths[0]?.includes(".") ? paths[0].slice(0, paths[0].indexOf(".") + 1) : "";
  return start && paths.every((path) => path.startsWith(start)) ? start : "";
}

function lanesOf(group, all) {
  const list = all.filter((lane) => lane.group === group);
  if (group === "marks" && names.value.some((curve) => curve.group === "contact")) list.push({ key: "contact", group, label: "contact", bands: contacts.value, at: bandAt });
  return list;
}

function bandAt(time, near) {
  return this.bands.find(({ from, to }) => from <= time + near && to >= time - near) ?? null;
}

/**
 * Returns {rows, height}: each row has its position y and height, and `lane` with its `label`, or `plot`.
 *
 * @param filter Only lanes and plots with this text in their name are shown.
 */
export function layout(filter) {
  const all = [...lanes.lanes.values()];
  const start = commonStart(all);
  const sought = filter.trim().toLowerCase();
  const rows = [];
  let y = AXIS;
  for (const { id } of GROUPS) {
    if (hidden.value.includes(id)) continue;
    const found = id === "curves" ? plots.value.map((plot) => ({ plot, label: plot.title, height: heightOf(plot) })) : lanesOf(id, all).map((lane) => ({ lane, label: short(lane.label, start), height: LANE }));
    const shown = found.filter(({ label, plot }) => [label, ...(plot?.series ?? []).map(({ name }) => name)].some((text) => text.toLowerCase().includes(sought)));
    shown.forEach((row, n) => {
      if (n === 0 && rows.length > 0) y += GAP;
      rows.push({ ...row, y, begins: n === 0 && rows.length > 0 });
      y += row.height;
    });
  }
  return { rows, height: y + GAP };
}

function short(label, start) {
  return label.startsWith(start) ? label.slice(start.length) : label;
}
