// The colours of curves: what a curve is about, such as a production or a chunk, has one colour in all plots, and keeps it while other
// curves come and go.

import { COLOURS, seriesColour } from "../parts/curve.js";

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

/** The colours of subjects, each chosen when a curve of the subject is plotted for the first time. */
export class Colours {
  #numbers = new Map(); // by subject

  /**
   * Returns the name of a subject's colour: at first, the one that the fewest other subjects have of which a curve may be in the same plot.
   *
   * @param known The subjects, as `subjectsOf` returns them.
   * @param shown The subjects of plotted curves.
   */
  of(subject, known, shown) {
    if (!this.#numbers.has(subject)) {
      const uses = new Array(COLOURS).fill(0);
      for (const [other, number] of this.#numbers) {
        if ([...known.get(subject).groups].some((group) => known.get(other)?.groups.has(group))) uses[number] += shown.has(other) ? SHOWN : 1;
      }
      this.#numbers.set(subject, uses.indexOf(Math.min(...uses)));
    }
    return seriesColour(this.#numbers.get(subject));
  }

  clear() {
    this.#numbers.clear();
  }
}
