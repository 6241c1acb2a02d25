// Curves as CSV.

import { valueAt } from "./curve.js";
import { exactTime, nameWithUnit } from "./units.js";

const DIGITS = 12; // the significant digits of a value; further ones are the rounding of a computation

/**
 * Returns curves as the text of a CSV file: a column of times, and one for each curve, with units. Where a curve has no value, the cell
 * is empty: one that neither holds nor goes on (without `slope`, see `drawCurves`) has values only at its own moments.
 *
 * @param until The end of curves that go on, and have no `until` of their own [s].
 */
export function csvText(all, until = 0) {
  const curves = all.map((curve) => ({ until, ...curve }));
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const goesOn = ({ times, values, slope, until }) => slope !== undefined && (values.at(-1) ?? null) !== null && until > times.at(-1);
  const moments = new Set(curves.flatMap((curve) => curve.times.map(exactTime)));
  for (const curve of curves.filter(goesOn)) moments.add(exactTime(curve.until));
  const times = [...moments].sort((one, other) => one - other);
  const heads = ["time [s]", ...curves.map(({ name, unit }) => nameWithUnit(name, unit))];
  const columns = curves.map((curve) => {
    const own = new Set(curve.times.map(exactTime));
    const valueText = (value) => (value === null ? "" : Number(value.toPrecision(DIGITS)));
    return times.map((time) => (curve.slope === undefined && !own.has(time) ? "" : valueText(valueAt(curve, time))));
  });
  const rows = times.map((time, n) => [time, ...columns.map((column) => column[n])].join(","));
  return `${[heads.map(quoted).join(","), ...rows].join("\n")}\n`;
}
