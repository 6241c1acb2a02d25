// Experiments as text: states, rates, levels.

import { literal } from "../parameters/values.js";
import { counted } from "../parts/count.js";
import { valueText } from "../parts/chunk.js";
import { nameWithUnit } from "../parts/units.js";
import { labelOf, whenText } from "../runs/wording.js";

const STATES = { running: "running", stopping: "stopping …", stopped: "stopped", finished: "finished", failed: "ended early", elsewhere: "run by another process" };

/** Returns the name of an experiment: its design, and when it began. */
export const experimentText = ({ name, made }) => `${name} ${whenText(made)}`;

export const stateText = ({ state }) => STATES[state] ?? state;

/** Returns the name of a column without its unit. */
export const columnText = (name) => (name === "wall_s" ? "computing time" : labelOf(name));

/** Returns the name of a column with its unit, if it has one. */
export const headText = ({ name, unit }) => nameWithUnit(columnText(name), unit);

/** Returns a value of a column; participants of an only group have their number. */
export function cellText(name, value, { groups }) {
  const [group, ...others] = Object.keys(groups ?? {});
  return name === "participant" && others.length === 0 && typeof value === "string" && value.startsWith(`${group} `) ? value.slice(group.length + 1) : valueText(value);
}

/** Returns the number of finished trials, of all. */
export function doneText({ done, total }) {
  return total === null ? counted(done, "trial") : `${done.toLocaleString("en")} of ${counted(total, "trial")}`;
}

/** Returns a duration in a unit that suits it. */
export function durationText(seconds) {
  if (seconds < 1) return "less than 1 s";
  if (seconds < 100) return `${Math.ceil(seconds)} s`;
  if (seconds < 100 * 60) return `${Math.round(seconds / 60)} min`;
  return seconds < 72 * 3600 ? `${(seconds / 3600).toFixed(1)} h` : `${Math.round(seconds / 86_400).toLocaleString("en")} days`;
}

export function rateText(rate) {
  return rate >= 10 ? `${Math.round(rate).toLocaleString("en")} a second` : rate >= 0.2 ? `${rate.toFixed(1)} a second` : `${(60 * rate).toFixed(1)} a minute`;
}

export const failuresText = (failures) => `${counted(failures, "trial")} failed`;

/** Returns the values that replace those of the design, in one line. */
export function changedText(changed) {
  return Object.entries(changed ?? {}).map(([name, value]) => `${name} ${name === "seed" ? value : levelsText([value].flat())}`).join(" · ");
}

/** Returns a level as text that `readLevels` and the command read as the same value: a text that is no plain word in quotation marks. */
function levelText(level) {
  if (level !== null && typeof level === "object") return JSON.stringify(level);
  if (typeof level !== "string") return level === null ? "None" : String(level);
  return /^[\p{L}_]([^"',;]*[^\s"',;])?$/u.test(level) && typeof literal(level) === "string" ? level : JSON.stringify(level);
}

export const levelsText = (levels) => levels.map(levelText).join(", ");

/** Returns the levels that a text lists, separated by commas, the text of each, and what is wrong: {levels, texts, problem}; either what
 * is wrong is null, or the others are. Texts may be in quotes.
 *
 * @param most The greatest number of `levels`, and of `characters` of a level, that the server takes. */
export function readLevels(text, most) {
  const none = { levels: null, texts: null };
  const wrong = (problem) => ({ ...none, problem: `${problem} (got '${text}')` });
  const parts = [""];
  for (const [token] of text.matchAll(/"(?:[^"\\]|\\.)*"?|[^",;]+|[,;]/g)) {
    if (/^[,;]$/.test(token)) parts.push("");
    else parts[parts.length - 1] += token;
  }
  if (parts.some((part) => part.trim() === "")) return wrong(parts.length === 1 ? "there is none" : "one is empty");
  const texts = parts.map((part) => part.trim());
  if (texts.length > most.levels) return { ...none, problem: `there are ${texts.length.toLocaleString("en")}, and at most ${most.levels} are possible` };
  const longest = Math.max(...texts.map((one) => Array.from(one).length));
  if (longest > most.characters) return { ...none, problem: `one has ${counted(longest, "character")}, and at most ${most.characters.toLocaleString("en")} are possible` };
  try {
    const levels = texts.map(literal);
    const twice = levels.find((level, place) => levels.indexOf(level) < place);
    return twice === undefined ? { levels, texts, problem: null } : wrong(`${levelText(twice)} is there twice`);
  } catch (error) {
    return wrong(error.message);
  }
}
