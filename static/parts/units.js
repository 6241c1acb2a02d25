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

/** Returns a time [s] in whole microseconds, as the run has it. */
export const exactTime = (time) => Math.round(time * 1e6) / 1e6;
