// The ticks of an axis, and their labels.

const STEPS = [1, 2, 5, 10];
const LONG_STEPS = [15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10_800, 21_600, 43_200, 86_400]; // [s]

/** Returns the round step that covers a span with at most `most` steps. */
export function stepFor(span, most) {
  if (!(span > 0)) return 1;
  const rough = span / Math.max(1, most);
  const power = 10 ** Math.floor(Math.log10(rough));
  return power * STEPS.find((step) => step * power >= rough * (1 - 1e-9));
}

/** Returns the round step of an axis of time [s], as `stepFor`; on one of an hour or more, also quarters of a minute, an hour and so on. */
export function timeStep({ from, to }, most) {
  const step = stepFor(to - from, most);
  if (to < 3600 || step <= 10) return step;
  const rough = (to - from) / most;
  return LONG_STEPS.find((one) => one >= rough * (1 - 1e-9)) ?? 86_400 * Math.max(1, Math.ceil(stepFor((to - from) / 86_400, most)));
}

/** Returns the multiples of a step from one number to another, as exactly as possible. */
export function ticks(from, to, step) {
  const found = [];
  const digits = digitsOf(step);
  for (let n = Math.ceil(from / step - 1e-6); n * step <= to + step * 1e-6; n += 1) found.push(Number((n * step).toFixed(digits)));
  return found;
}

/** Returns the number of decimals for multiples of a step. */
export function digitsOf(step) {
  return Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
}

/** Returns a round range with some margin around the values: [least, most]. */
export function roundRange(least, most) {
  if (!(least <= most)) return [0, 1];
  if (most - least < 1e-9 * Math.max(1, Math.abs(most))) {
    const room = Math.abs(most) * 0.1 || 1;
    return roundRange(least - room, most + room);
  }
  const step = stepFor(most - least, 8);
  return [Math.floor(least / step + 1e-6) * step, Math.ceil(most / step - 1e-6) * step];
}

/** Returns a value of a curve as text with at most four significant digits. */
export function numberText(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  const size = Math.abs(value);
  const digits = size >= 1000 ? 0 : size >= 100 ? 1 : size >= 1 ? 2 : 3;
  return value.toFixed(digits).replace(/^-(0(\.0*)?)$/, "$1");
}

/** Returns the same without zeros at its end, as scales show it. */
export const scaleText = (value) => numberText(value).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
