// The units of measured values, which are the endings of their names; times in the unit of the run.

/** [ending, unit, decimals, factor to that unit], longer endings before their own endings. */
const UNITS = [
  ["_m_s", "m/s", 2],
  ["_n_s", "N s", 1],
  ["_deg", "°", 1],
  ["_rad", "°", 1, 180 / Math.PI],
  ["_m", "m", 3],
  ["_cm", "cm", 1],
  ["_s", "s", 2],
  ["_n", "N", 1],
  ["_kg", "kg", 2],
  ["_j", "J", 2],
];

/** Returns the name of a measured value without its unit, and the unit: `peak_angle_deg` becomes {label: "peak angle", unit: "°", ...}. */
export function unitOf(name) {
  const [ending, unit, digits, factor = 1] = UNITS.find(([one]) => name.endsWith(one)) ?? ["", "", 4];
  return { label: name.slice(0, name.length - ending.length).replaceAll("_", " "), unit, digits, factor };
}

/** Returns a measured number in its unit, with the decimals of that. */
export function measuredText(name, value) {
  const { unit, digits, factor } = unitOf(name);
  return Number.isInteger(value) && unit === "" ? String(value) : (value * factor).toFixed(digits);
}

/** Returns a name with its unit, if it has one, as headings have it: `speed [m/s]`. */
export const nameWithUnit = (name, unit) => (unit ? `${name} [${unit}]` : name);

/** Returns a value with its unit, if it has one: `1.2 m`, `5°`. */
export const valueWithUnit = (value, unit) => `${value}${unit && unit !== "°" ? " " : ""}${unit ?? ""}`;

const HOUR = 3600; // [s]

/** Returns a time [s] as people read it: seconds with their unit; from an hour on, hours, minutes and seconds: `1:15:12.30`. Files have
 * seconds.
 *
 * @param digits The number of decimals; null for those that are needed.
 * @param longest The longest of several times that are to look alike [s]. */
export function timeText(time, digits = 2, longest = time) {
  return `${plainTime(time, digits, longest)}${longest < HOUR ? " s" : ""}`;
}

/** Returns the same without the unit, as fields and columns show it; `timeUnit` is theirs. */
export function plainTime(time, digits = 2, longest = time) {
  const write = (seconds) => (digits === null ? String(exactTime(seconds)) : seconds.toFixed(digits));
  if (longest < HOUR) return write(time);
  const whole = Number(write(time));
  const [hours, minutes] = [Math.floor(whole / HOUR), Math.floor((whole % HOUR) / 60)];
  const two = (text) => (text.split(".")[0].length < 2 ? `0${text}` : text);
  return `${hours}:${two(String(minutes))}:${two(write(whole - HOUR * hours - 60 * minutes))}`;
}

/** Returns the unit in the heading of times, of which this is the longest [s]: ` [s]`; from an hour on, an empty text. */
export const timeUnit = (longest) => (longest < HOUR ? " [s]" : "");

/** Returns the time [s] of a text as `timeText` writes it: a number of seconds, or hours, minutes and seconds; without hours, there may be
 * any number of minutes. NaN for any other text. */
export function timeOfText(text) {
  const plain = text.trim().replace(/ ?s$/, "");
  const [, hours = 0, minutes, rest] = plain.match(/^(?:(\d+):(?=[0-5]\d:))?(\d+):([0-5]\d(?:\.\d*)?)$/) ?? [];
  if (minutes !== undefined) return HOUR * Number(hours) + 60 * Number(minutes) + Number(rest);
  return plain === "" ? NaN : Number(plain);
}

/** An example of what `timeOfText` reads. */
export const TIMES = "1.5 or 1:15:12.3";

/** Returns a time [s] in whole microseconds, as the run has it. */
export const exactTime = (time) => Math.round(time * 1e6) / 1e6;
