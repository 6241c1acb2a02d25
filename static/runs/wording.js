// Recordings as text: date, parameters, results.

import { valueText } from "../parts/chunk.js";
import { measuredText, timeText, unitOf, valueWithUnit } from "../parts/units.js";
import { isOrphan } from "./list.js";

const ENDED = {
  stop: "the model called stop()",
  done: "no agent had anything left to do",
  end: "the program was over",
  exit: "the program ended itself",
  left: "left before its end",
  limits: "its time was over",
};

const DAY = new Intl.DateTimeFormat(undefined, { day: "numeric", month: "short" });
const DATE = new Intl.DateTimeFormat(undefined, { day: "numeric", month: "short", year: "numeric" });
const CLOCK = new Intl.DateTimeFormat(undefined, { hour: "2-digit", minute: "2-digit", second: "2-digit", hourCycle: "h23" });
const FULL = new Intl.DateTimeFormat(undefined, { dateStyle: "medium", timeStyle: "medium", hourCycle: "h23" });
const AGO = new Intl.RelativeTimeFormat("en", { numeric: "auto", style: "short" });
const UNITS = [["year", 31_536_000], ["month", 2_592_000], ["day", 86_400], ["hour", 3600], ["minute", 60]];

/** Returns when a run began: the time if today, day and time if this year, otherwise the date. */
export function whenText(made) {
  const then = new Date(1000 * made);
  const today = then.toDateString() === new Date().toDateString();
  if (then.getFullYear() !== new Date().getFullYear()) return DATE.format(then);
  return today ? CLOCK.format(then) : `${DAY.format(then)} ${CLOCK.format(then).slice(0, 5)}`;
}

export function whenInFull(made) {
  return FULL.format(new Date(1000 * made));
}

const TURNS = /[\u202a-\u202e\u2066-\u2069]/; // characters that change the direction of the text after them

/** Returns a name without effect on the direction of the text around it. */
function apart(name) {
  if (!TURNS.test(name)) return name;
  const open = name.match(/[\u2066-\u2068]/g)?.length ?? 0;
  return `\u2068${name}${"\u2069".repeat(open + 1)}`;
}

/** Returns the name that a user has given a recording, else where it is a branch; recordings of one tree may have the same. */
const plainText = (run) => apart(run.label?.name ?? "") || placeText(run);

const placeText = ({ branched }) => (branched === null ? "" : `at ${timeText(branched)}`);

/** Returns the name of a recording with the number that the server has given it, as others of its tree have the same: `at 0.12 s (2)`. */
const numbered = (run) => (run.number > 1 ? `${plainText(run)} (${run.number})` : plainText(run));

/** Returns the name that a user has given a recording, different from those of its branches; an empty text if there is none. */
export function ownName(run) {
  return run.label?.name ? numbered(run) : "";
}

/** Returns the name of a recording among its branches: what the user has called it, else where it is a branch, or when it began. */
export function nameInTree(run) {
  return numbered(run) || whenText(run.made);
}

/** Returns the name of a recording: what the user has called it, else its model, when it began, and where it is a branch. */
export function nameOf(run) {
  return ownName(run) || [run.model || run.id, whenText(run.made), branchText(run)].filter(Boolean).join(" ");
}

/** Returns what an open session shows: a recording by its name, which a list of recordings may have, or a model. */
export function openText({ recorded, model }, list) {
  if (!recorded) return `run of ${model}`;
  const run = list?.find(({ id }) => id === recorded);
  return `recording ${run ? nameOf(run) : recorded}`;
}

/** Returns when a run began, or its own name instead if that is wanted, and where it is a branch: branches begin with their run. */
export function beginningText(run, named = false) {
  return [(named && ownName(run)) || whenText(run.made), branchText(run)].filter(Boolean).join(", ");
}

/** Returns where a branch leaves its run, which began at the same time; an empty text if it is none. */
export function branchText(run) {
  if (run.branched === null) return "";
  return `branch ${run.label?.name ? placeText(run) : numbered(run)}`;
}

/** Returns when, and of which run in a list of recordings, a recording is a branch; a dash if it is none. */
export function originText(run, list) {
  if (run.branched === null) return "–";
  const listed = list?.find(({ id }) => id === run.id) ?? run;
  const origin = list?.find(({ id }) => id === listed.origin);
  const from = origin ? ` of ${nameOf(origin)}` : isOrphan(listed) ? " of a recording that was deleted" : "";
  return `${placeText(run)}${from}`;
}

/** Returns how long ago something was, as text. */
export function agoText(made, now = Date.now() / 1000) {
  const passed = now - made;
  const [unit, length] = UNITS.find(([, seconds]) => passed >= seconds) ?? [];
  return unit ? AGO.format(-Math.floor(passed / length), unit) : "just now";
}

export function sizeText(bytes) {
  if (bytes < 1000) return `${bytes} B`;
  if (bytes < 1e6) return `${(bytes / 1e3).toFixed(0)} kB`;
  return bytes < 1e9 ? `${(bytes / 1e6).toFixed(1)} MB` : `${(bytes / 1e9).toFixed(1)} GB`;
}

/** Returns the initial value of a setting, and the last one if a user changed it during the run: `0.25 → 0.27`. */
export function courseText(begun, last) {
  return `${begun === undefined ? "–" : valueText(begun)}${last === undefined ? "" : ` → ${valueText(last)}`}`;
}

/** Returns the settings of a run as [name, text]: its parameters, and other values that a user changed during it. */
export function settingsOf({ parameters, changed }) {
  return Object.keys({ ...parameters, ...changed }).map((name) => [name, courseText(parameters[name], changed[name])]);
}

/** Whether a setting is not the default, or was changed during the run. */
export function isDifferent(run, name) {
  return run.different.includes(name) || name in run.changed;
}

/** Returns the settings that differ from the defaults in one line. */
export function differentText(run) {
  return settingsOf(run).filter(([name]) => isDifferent(run, name)).map(([name, text]) => `${name} ${text}`).join(", ");
}

/** Whether a recording was closed before its run was over. */
function wasLeft(run) {
  return run.ended === "left";
}

/** Returns the result of a run in a few words. */
export function outcomeText(run) {
  if (run.problem) return "unreadable";
  if (run.failed) return "failed";
  if (run.result?.outcome) return String(run.result.outcome);
  const first = Object.entries(run.result ?? {})[0];
  if (first) return `${labelOf(first[0])} ${measureText(...first)}`;
  if (run.ended && !wasLeft(run)) return "ended";
  return run.session ? "not over" : "not finished";
}

/** Returns the first measure that follows the outcome in a result, as [name, value]; null if there is none, or it is no number. */
export function firstMeasure({ result }) {
  const { outcome, ...measures } = result ?? {};
  const [first] = Object.entries(measures);
  return outcome && typeof first?.[1] === "number" ? first : null;
}

/** Returns the first measure that follows the outcome in a result, as text; an empty text if there is none. */
export function resultText(run) {
  const [name, value] = firstMeasure(run) ?? [];
  if (name === undefined) return "";
  return valueWithUnit(measuredText(name, value), unitOf(name).unit);
}

/** Returns how a run ended, as text. */
export function endedText(run) {
  if (run.problem || run.failed) return run.problem ?? run.failed;
  if (wasLeft(run) && run.branched !== null) return "its past was changed";
  if (run.ended) return ENDED[run.ended] ?? run.ended;
  return run.session ? "goes on, or waits" : "its end is not recorded";
}

/** Returns a name of the model without its unit: `peak_angle_deg` becomes `peak angle`. */
export function labelOf(name) {
  return unitOf(name).label;
}

/** Returns a measured value with the unit in its name's ending. */
export function measureText(name, value) {
  if (typeof value !== "number") return value === null || value === undefined ? "–" : valueText(value);
  const { unit, factor } = unitOf(name);
  return valueWithUnit(valueText(value * factor), unit);
}

/** Returns all text that a search includes. */
export function textOf(run) {
  const own = [run.id, run.model, `seed ${run.seed}`, outcomeText(run), endedText(run), branchText(run), whenText(run.made), ownName(run), run.label?.note ?? "", ...(run.label?.tags ?? [])];
  return [...own, ...settingsOf(run).map(([name, text]) => `${name} ${text}`)].join("  ").toLowerCase();
}
