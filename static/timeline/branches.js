// The branches of the run as a small tree on the axis of time: each begins where its run was changed. They are opened, compared, named
// and deleted here; nothing is shown as long as the run has no branch.

import { commandsOf } from "../commands.js";
import { compareRuns } from "../compare/compare.js";
import { remembered } from "../local_storage.js";
import { isThere } from "../needs.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { deleteRuns, openRun } from "../runs/actions.js";
import { labelRun } from "../runs/label.js";
import { followRuns, isOrphan, runs } from "../runs/list.js";
import { outcomeText, whenText } from "../runs/wording.js";
import { counted } from "../parts/count.js";
import { chooseLive } from "../bar/models.js";
import { complain, session, shownRecording as shown } from "../store.js";
import { computed, html, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { commandText } from "./commands.js";
import { placeOf } from "./draw.js";
import { column } from "./rows.js";
import { furthest } from "./seek.js";
import { span } from "./view.js";

const MAX_CHARACTERS = 300; // of the change that a tooltip shows

const open = remembered("branches open", true);

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
  const rootOf = (run) => lineOf(run).at(-1).id;
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

/** Those of the present run; none without a models folder, from which they would be opened. */
const tree = computed(() => (isThere("models folder") ? treeOf(runs.value ?? [], shown.value) : []));

/** Returns the newest time of a run of the tree [s]; of the one that is shown, the list may not have it yet. */
function endOf(run) {
  return run.id === shown.value && run.session === session.value?.id ? furthest.value : run.time;
}

/** The newest time of the run and of the branches that are shown [s]: the axis goes as far. */
export const reach = computed(() => Math.max(furthest.value, ...(open.value && tree.value.length > 1 ? tree.value.map(({ run }) => endOf(run)) : [])));

/** Shows another branch: the open session that writes it, where it is, or its recording, at the moment from which it differs from the shown run. */
async function show(run) {
  try {
    if (run.session && (await chooseLive(run.id))) return;
  } catch (error) {
    complain(error.message);
    return;
  }
  await openRun(run, sameUntil(runs.value ?? [], run.id, shown.value));
}

function compare(run) {
  compareRuns(run.id, shown.value);
}

/** The names of the branches by their ids; those of the same name are numbered: `at 0.12 s`, `at 0.12 s (2)`. */
const names = computed(() => {
  const counts = new Map();
  const numbered = ({ run }) => {
    const name = run.label?.name || (run.branched === null ? whenText(run.made) : `at ${run.branched.toFixed(2)} s`);
    counts.set(name, (counts.get(name) ?? 0) + 1);
    return [run.id, counts.get(name) > 1 ? `${name} (${counts.get(name)})` : name];
  };
  return new Map(tree.value.map(numbered));
});

/** Returns what a user did first where a branch begins. */
function changeText({ branched, change }) {
  if (branched === null) return "";
  const what = change ? commandText([branched * 1e6, "", "command", change]).join(" ").slice(0, MAX_CHARACTERS) : "no change by hand";
  return `\nfrom ${branched.toFixed(2)} s on: ${what}`;
}

commandsOf(() =>
  (tree.value.length > 1 ? tree.value : []).flatMap(({ run }) => {
    const mine = run.id === shown.value;
    const of = (text, work, why = "") => ({ text: `${text}: ${names.value.get(run.id)}`, group: `Branch ${run.id}`, work, ready: () => !why, why: () => why });
    const isShown = mine ? "It is shown now." : "";
    return [
      of("Show the branch", () => show(run), isShown || run.problem || ""),
      of("Compare the shown run with the branch", () => compare(run), isShown),
      of("Rename the branch (name, note, tags)", () => labelRun(run)),
      of("Delete the branch", () => deleteRuns([run]), isShown || (run.session ? "An open run writes it." : "")),
    ];
  }),
);

function Row({ run, depth, width }) {
  const mine = run.id === shown.value;
  const view = { column: column.value, width, span: span.value };
  const inside = (x) => Math.min(Math.max(x, view.column), width);
  const end = endOf(run);
  const [from, to] = [inside(placeOf(run.branched ?? 0, view)), inside(placeOf(end, view))];
  const name = names.value.get(run.id);
  const title = `${name}: ${outcomeText(run)}, ${end.toFixed(2)} s${changeText(run)}${isOrphan(run) ? "\nthe recording that it is a branch of was deleted" : ""}${run.label?.note ? `\n${run.label.note}` : ""}`;
  const remove = async () => {
    await deleteRuns([run]);
    if (document.activeElement === document.body) document.querySelector(".branches-head, .timeline-stage")?.focus(); // its button is gone
  };
  return html`<li class=${mine ? "mine" : ""} data-branch=${run.id}>
    <${Button} class="branch-name" style=${{ width: `${view.column}px`, paddingLeft: `${8 + 10 * depth}px` }} aria-current=${mine} title=${mine ? `${title}\nshown` : `${title}\nShow it`} disabled=${Boolean(run.problem)} onClick=${() => mine || show(run)}>${depth > 0 ? "└ " : ""}${name}${isOrphan(run) ? html` <small>origin gone</small>` : null}<//>
    <span class="branch-way" style=${{ left: `${from}px`, width: `${Math.max(2, to - from)}px` }} aria-hidden="true"></span>
    <span class="branch-actions">
      ${mine ? null : html`<button class="bare" aria-label="Compare ${name}" title="Compare with the shown run" onClick=${() => compare(run)}>Compare</button>`}
      <button class="bare" aria-label="Name ${name}" title="Name, note, tags" onClick=${() => labelRun(run)}><${Icon} name="pen" /></button>
      ${run.session || mine ? null : html`<button class="bare" aria-label="Delete ${name}" title="Delete" onClick=${remove}><${Icon} name="trash" /></button>`}
    </span>
  </li>`;
}

export function Branches() {
  const box = useRef(null);
  const [width, setWidth] = useState(600);
  const several = tree.value.length > 1;
  useEffect(followRuns, []);
  useLayoutEffect(() => {
    if (!box.current) return undefined;
    const watch = new ResizeObserver(() => box.current && setWidth(box.current.clientWidth));
    watch.observe(box.current);
    return () => watch.disconnect();
  }, [several]);
  if (!several) return null;
  return html`<section ref=${box} class="branches" aria-label="Branches">
    <button class="bare branches-head" aria-expanded=${open.value} onClick=${() => (open.value = !open.value)}><${Icon} name=${open.value ? "down" : "right"} />${counted(tree.value.filter(({ depth }) => depth > 0).length, "branch", "branches")}</button>
    ${open.value ? html`<ul>${tree.value.map(({ run, depth }) => html`<${Row} key=${run.id} run=${run} depth=${depth} width=${width} />`)}</ul>` : null}
  </section>`;
}
