// The colours of curves: what a curve is about, such as a production or a chunk, has one colour in all plots, and keeps it while other
// curves come and go.

import { COLOUR_COUNT, seriesColour } from "../parts/curve.js";

const ALL = Array.from({ length: COLOUR_COUNT }, (_, n) => seriesColour(n));
const SHOWN = 1000; // how much worse a colour is that a plotted curve has, compared with one that is not plotted any more

/** Returns what a curve is about: its name without the quantity, which is its group or the last word of it. */
export function subjectOf({ name, group }) {
  for (const end of [` ${group}`, `.${group}`, ` ${group.split(" ").at(-1)}`]) {
    const at = name.lastIndexOf(end);
    if (at > 0) return name.slice(0, at) + name.slice(at + end.length);
  }
  return name;
}

/** Returns the groups of curves of each subject, in the order in which the subjects are known: {place, groups} by subject. */
export function subjectsOf(curves) {
  const found = new Map();
  for (const { subject, group } of curves) {
    if (!found.has(subject)) found.set(subject, { place: found.size, groups: new Set() });
    found.get(subject).groups.add(group);
  }
  return found;
}

/**
 * Returns the names of the colours of subjects, by subject. A new one has the colour that the fewest other subjects have of which a curve
 * may be in the same plot; of several such colours, the preferred one.
 *
 * @param colours Those that are known.
 * @param subjects The subjects of all curves, as `subjectsOf` returns them.
 * @param shown The subjects of plotted curves: all of them have a colour then.
 * @param preferred Returns the preferred colour of a subject; undefined for none.
 */
export function withColours(colours, subjects, shown, preferred) {
  const found = new Map(colours);
  for (const subject of shown) {
    if (found.has(subject)) continue;
    const uses = new Map(ALL.map((colour) => [colour, 0]));
    for (const [other, colour] of found) {
      if ([...subjects.get(subject).groups].some((group) => subjects.get(other)?.groups.has(group))) uses.set(colour, uses.get(colour) + (shown.has(other) ? SHOWN : 1));
    }
    const best = ALL.filter((colour) => uses.get(colour) === Math.min(...uses.values()));
    const wish = preferred(subject);
    found.set(subject, best.includes(wish) ? wish : best[0]);
  }
  return found;
}
