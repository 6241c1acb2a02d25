// The layout: which parts of the page are shown, how large they are, on which side, and in which window.

import { alone, embedded } from "./address.js";
import { command } from "./commands.js";
import { remembered } from "./local_storage.js";
import { computed, effect } from "./vendor/preact.js";
import { hasScene, session } from "./store.js";

/** The parts of the page, with their titles. */
export const AREAS = { scene: "3D view", panels: "Panels", timeline: "Timeline" };

/** Whether there is a 3D view, with something to see in it; otherwise the panels have all the room. While a model loads, it is as for the previous one. */
export const hasWorld = remembered("has world", true);
effect(() => {
  if (session.value?.kind) hasWorld.value = hasScene.value;
});

/** Returns a value that models with a world and those without one have each for themselves; it is stored in the browser. */
function ofKind(name, otherwise) {
  const [withWorld, without] = [remembered(name, otherwise), remembered(`${name} without a world`, otherwise)];
  const kept = () => (hasWorld.value ? withWorld : without);
  return {
    get value() {
      return kept().value;
    },
    set value(value) {
      kept().value = value;
    },
  };
}

const isAreaThere = (area) => alone === null && area in AREAS && (area !== "scene" || hasWorld.value);

const notThere = (area) => (alone === null && area === "scene" ? "This model has no 3D view." : "This window shows one panel.");

const ROWS = 344; // the height of the default rows of a model with a body [px]
const LEAST = 140; // with some rows of the timeline [px]
const OTHERS = 400; // the height of everything else on a low page, where bar and tabs have two lines each [px]
/** The width of the panels [px]. By default, all tabs can be seen, and wide windows give the panels more room too. */
export const panelsWidth = ofKind("side width", embedded === null ? Math.max(784, Math.round(0.38 * innerWidth)) : Math.round(0.45 * innerWidth));
/** The height of the timeline [px]. By default, it leaves the panels a usable height on a low page. */
export const timelineHeight = ofKind("timeline height", Math.round(Math.max(LEAST, Math.min(0.43 * innerHeight, innerHeight - OTHERS, Math.max(ROWS, 0.34 * innerHeight)))));
/** Whether the panels are on the left. */
export const swapped = remembered("swapped sides", false);
const collapsed = ofKind("collapsed", []);
const largest = remembered("maximised", ""); // a part; or none
/** The part that fills the page; null for none. */
export const maximised = computed(() => (isAreaThere(largest.value) ? largest.value : null));

/** Returns whether a part is collapsed: a strip at the edge of the page. */
export function isCollapsed(area) {
  return collapsed.value.includes(area);
}

/** Returns whether a part can be collapsed now: something else is beside it. */
function canCollapse(area) {
  return area === "timeline" || (hasWorld.value && !isCollapsed(area === "scene" ? "panels" : "scene"));
}

function collapse(area) {
  largest.value = "";
  collapsed.value = [...collapsed.value.filter((other) => other !== area), area];
}

function expand(area) {
  collapsed.value = collapsed.value.filter((other) => other !== area);
}

/** Lets a part fill the page, or no longer. */
function maximise(area) {
  largest.value = maximised.value === area ? "" : area;
}

const KEYS = { panels: "m", scene: "Shift+m", timeline: null };

/** The commands of a part: {maximise, collapse, expand}. */
export const layoutCommands = Object.fromEntries(
  Object.entries(AREAS).map(([area, title]) => {
    const name = title === "3D view" ? title : title.toLowerCase();
    const named = (text, work, ready, why = () => "", key = null) =>
      command({ text: `${text} the ${name}`, key, group: "Page", work, ready: () => isAreaThere(area) && ready(), why: () => (isAreaThere(area) ? why() : notThere(area)) });
    return [
      area,
      {
        maximise: named("Maximise", () => maximise(area), () => true, undefined, KEYS[area]),
        collapse: named("Collapse", () => collapse(area), () => !isCollapsed(area) && canCollapse(area), () => (isCollapsed(area) ? "It is collapsed already." : "Nothing else is beside it.")),
        expand: named("Expand", () => expand(area), () => isCollapsed(area), () => "It is not collapsed."),
      },
    ];
  }),
);

/** Swaps the 3D view and the panels. */
export const swap = command({ text: "Swap the sides of the 3D view and the panels", group: "Page", work: () => (swapped.value = !swapped.value), ready: () => isAreaThere("scene"), why: () => notThere("scene") });

command({ text: "Restore the layout after a part was maximised", key: "Escape", group: "Page", work: () => (largest.value = ""), ready: () => maximised.value !== null, why: () => "No part is maximised." });
