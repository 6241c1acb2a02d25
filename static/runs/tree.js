// The trees that recordings and their branches form: which comes from which, and until when two are the same.

/** Returns a function that maps a run of the list to its lineage: the run itself, then its origin, the origin of that, and so on, as
 * [{id, run, left}]. `run` is undefined for a recording that was deleted; `left` is until when the first run is the same as this one [s].
 *
 * When a run's past is changed, its earlier future is kept as a copy. If the run is then changed again at an earlier time, the first copy
 * branches from the second one, which contains the run up to the first change. */
function lines(list) {
  const known = new Map(list.map((run) => [run.id, run]));
  const copies = Map.groupBy(list.filter(({ copied }) => copied), (run) => run.copied[0]);
  const later = (run) => copies.get(run.copied[0]).filter((other) => other.kept > run.kept && other.copied[1] < run.copied[1]);
  const first = (list) => list.toSorted((one, other) => one.kept - other.kept)[0];
  const stepsOf = (run) => {
    const copy = run.copied ? first(later(run)) : undefined;
    if (copy) return [[copy.id, run.copied[1]]];
    return run.origin === null || run.branched === null ? [] : [[run.origin, run.branched], ...run.ancestors];
  };
  return (begin) => {
    const line = [{ id: begin.id, run: begin, left: Infinity }];
    let steps = stepsOf(begin);
    while (steps.length > 0) {
      const [[id, at], ...others] = steps;
      if (line.some((one) => one.id === id)) break;
      const run = known.get(id);
      line.push({ id, run, left: Math.min(line.at(-1).left, at) });
      steps = run ? stepsOf(run) : others;
    }
    return line;
  };
}

/** Returns the tree that a recording is in, as rows with their depth: a branch follows the nearest recording from which it comes; those that
 * come from one that was deleted are side by side. */
export function treeOf(list, id) {
  const lineOf = lines(list);
  const rootOf = (run) => lineOf(run).at(-1).id; // the first recording of its tree
  const mine = list.find((run) => run.id === id);
  if (!mine) return [];
  const root = rootOf(mine);
  const below = Map.groupBy(list.filter((run) => rootOf(run) === root), (run) => lineOf(run).slice(1).find((one) => one.run)?.id ?? null);
  const rowsBelow = (id, depth) =>
    (below.get(id) ?? [])
      .toSorted((one, other) => (one.branched ?? 0) - (other.branched ?? 0) || (one.kept ?? one.made) - (other.kept ?? other.made))
      .flatMap((run) => [{ run, depth }, ...rowsBelow(run.id, depth + 1)]);
  return rowsBelow(null, 0);
}

/** Returns until when two runs of a tree are the same [s]; null if they are not in one. */
export function sameUntil(list, one, other) {
  const lineOf = lines(list);
  const [mine, its] = [one, other].map((id) => lineOf(list.find((run) => run.id === id)));
  const shared = mine.find(({ id }) => its.some((each) => each.id === id));
  if (!shared) return null;
  const moment = Math.min(shared.left, its.find(({ id }) => id === shared.id).left);
  return moment === Infinity ? null : moment;
}
