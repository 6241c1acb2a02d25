// Events as text: groups of kinds, and each event as a line.

import { chunkText, requestText, valueText } from "../parts/chunk.js";
import { plainTime } from "../parts/units.js";
import { commandText, isOfUser } from "../timeline/commands.js";
import { furthest, runTimeText } from "../timeline/seek.js";
import { GROUPS as REGISTERED, TEXTS } from "../trace_kinds.js";

/** The groups of events in the trace's filter: {id, text, kinds, first: whether they are shown by default}. The page itself adds contacts. */
export const GROUPS = REGISTERED.map((group) => (group.id === "result" ? { ...group, text: "Contacts and results", kinds: ["contact", ...group.kinds] } : group));

const GROUPED = new Set(GROUPS.flatMap(({ kinds }) => kinds));

/** Returns a function that checks whether the group of a kind is among those with these names; unregistered kinds are "other" events. */
export function isInGroups(names) {
  const kinds = new Set(GROUPS.filter(({ id }) => names.includes(id)).flatMap((group) => group.kinds));
  const others = names.includes("other");
  return (kind) => kinds.has(kind) || (others && !GROUPED.has(kind));
}

/** Texts that need more than the data's values. */
const OWN_TEXTS = {
  compile: (data) => ["compiled", `${data.production} from ${(data.parents ?? []).join(" and ")}`],
  command: (_data, event) => [isOfUser(event) ? "user" : "program", commandText(event).join(" ")],
  contact: ({ force, lasts }) => ["touch", `begins: ${(1000 * lasts).toFixed(0)} ms, with up to ${force.toFixed(0)} N`],
  planning_unit: (data) => ["plan", `${data.name} ${data.what}${data.by ? ` by ${data.by}` : ""}`],
  conflict: (data) => ["matching", Object.keys(data.utilities ?? {}).join(", ") || "none"],
  buffer: (data) => ["holds", data.chunk ? chunkText(data.chunk) : "nothing"],
  retrieval: (data) => (data.failed ? ["fails", "nothing is retrieved"] : ["retrieved", data.chunk]),
  add: (data) => [data.merged ? "merges" : "adds", chunkText(data.chunk)],
  request: (data) => ["request", data.asked === undefined ? pairs(data) : requestText(data.asked)],
  search: (data) => [data.bottom_up ? "notices" : "searches", `${data.asked}: ${data.noticed?.length ?? 0} noticed${data.why ? `, ${data.why}` : ""}`],
  sight: (data) => (data.failed ? ["sees", "nothing of that kind"] : ["sees", chunkText(data.chunk)]),
};

/** Returns [what happened, its details] of an event; a firing is described by its production alone. */
export function eventText(event) {
  const [, , kind, data] = event;
  if (kind === "fire") return [data.production, pairs(data.bound)];
  if (OWN_TEXTS[kind]) return OWN_TEXTS[kind](data ?? {}, event);
  const [title, text] = TEXTS[kind] ?? [kind, ""];
  return [title, text ? text.replace(/\{(\w+)\}/g, (_, name) => valueText(data?.[name])) : pairs(data)];
}

const slots = ({ chunk }) => chunk;

/** The values that texts of events list, by their names. */
const LISTED = {
  fire: ({ bound }) => bound,
  command: (_data, event) => Object.fromEntries([commandText(event)]),
  buffer: slots,
  add: slots,
  sight: slots,
  request: (data) => (data.asked === undefined ? data : null),
};

/** Values that texts of events leave out, with their names. */
const LEFT_OUT = {
  conflict: ({ utilities = {} }) => Object.entries(utilities).map(([production, value]) => [`utility of ${production}`, value]),
  request: ({ candidates = [] }) => candidates.map((candidate) => [`activation of ${candidate[0]}`, candidate.at(-1)]),
  search: ({ noticed = [] }) => noticed.map(([feature, salience], n) => [`noticed ${n + 1}`, { ...feature, salience }]),
};

/** Returns the values of an event by names that users know: slots, variables, utilities; what has no name is in the text of the event. */
export function eventValues(event) {
  const [, , kind] = event;
  const data = event[3] ?? {};
  const [title, text] = eventText(event);
  const template = TEXTS[kind]?.[1];
  const listed = LISTED[kind]?.(data, event) ?? (OWN_TEXTS[kind] || template ? null : data);
  if (listed && !Object.keys(listed).some((name) => /^\d+$/.test(name))) return listed;
  const leftOut = template ? Object.entries(data).filter(([name]) => !template.includes(`{${name}}`)) : LEFT_OUT[kind]?.(data);
  return { [title]: text, ...Object.fromEntries(leftOut ?? []) };
}

/** Returns names with their values in one line. */
export function pairs(data) {
  return Object.entries(data ?? {})
    .map(([name, value]) => `${name}=${valueText(value)}`)
    .join("  ");
}

/** Returns the time of an event [us] as text without a unit, as lists of events show it; `longest` as in `timeText`. */
export function eventTimeText(time, longest = furthest.value) {
  return plainTime(time / 1e6, 3, longest);
}

/** Returns the moment of an event [us] as text with its unit, as sentences have it. */
export const eventMomentText = (time) => runTimeText(time / 1e6, 3);
