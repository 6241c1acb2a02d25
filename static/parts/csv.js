// Curves as CSV.

import { valueAt } from "./curve.js";

/** Returns curves as the text of a CSV file: a column of times, and one for each curve, with units. */
export function csvText(curves) {
  const quoted = (text) => `"${text.replaceAll('"', '""')}"`;
  const times = [...new Set(curves.flatMap((curve) => curve.times))].sort((one, other) => one - other);
  const heads = ["time [s]", ...curves.map(({ name, unit }) => (unit ? `${name} [${unit}]` : name))];
  const rows = times.map((time) => [time, ...curves.map((curve) => valueAt(curve.times, curve.values, time) ?? "")].join(","));
  return `${[heads.map(quoted).join(","), ...rows].join("\n")}\n`;
}
