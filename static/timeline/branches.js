// The branches of the run as a small tree on the axis of time: each begins where its run was changed. They are opened, compared, named
// and deleted here; nothing is shown as long as the run has no branch.

import { commandsOf } from "../commands.js";
import { compareRuns } from "../compare/compare.js";
import { remembered } from "../local_storage.js";
import { isAvailable } from "../needs.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { useSize } from "../parts/size.js";
import { timeText } from "../parts/units.js";
import { deleteRuns, openRun } from "../runs/actions.js";
import { labelRun } from "../runs/label.js";
import { followRuns, isOrphan, runs } from "../runs/list.js";
import { sameUntil, treeOf } from "../runs/tree.js";
import { nameInTree, outcomeText } from "../runs/wording.js";
import { counted } from "../parts/count.js";
import { chooseLive } from "../bar/models.js";
import { notify, session, shownRecording as shown } from "../store.js";
import { computed, html, useEffect, useRef } from "../vendor/preact.js";
import { commandText } from "./commands.js";
import { placeOf, viewOf } from "./draw.js";
import { furthest } from "./seek.js";

const MAX_CHARACTERS = 300; // of the change that a tooltip shows

const open = remembered("branches open", true);

/** Those of the present run; none without a models folder, from which they would be opened. */
const tree = computed(() => (isAvailable("models folder") ? treeOf(runs.value ?? [], shown.value) : []));

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
    notify(error.message);
    return;
  }
  await openRun(run, sameUntil(runs.value ?? [], run.id, shown.value));
}

function compare(run) {
  compareRuns(run.id, shown.value);
}

/** Returns what a user did first where a branch begins. */
function changeText({ branched, change }) {
  if (branched === null) return "";
  const what = change ? commandText([branched * 1e6, "", "command", change]).join(" ").slice(0, MAX_CHARACTERS) : "no change by hand";
  return `\nfrom ${timeText(branched)} on: ${what}`;
}

commandsOf(() =>
  (tree.value.length > 1 ? tree.value : []).flatMap(({ run }) => {
    const mine = run.id === shown.value;
    const of = (text, work, why = "") => ({ text: `${text}: ${nameInTree(run)}`, group: `Branch ${run.id}`, work, ready: () => !why, why: () => why });
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
  const view = viewOf(width);
  const inside = (x) => Math.min(Math.max(x, view.column), width);
  const end = endOf(run);
  const [from, to] = [inside(placeOf(run.branched ?? 0, view)), inside(placeOf(end, view))];
  const name = nameInTree(run);
  const title = `${name}: ${outcomeText(run)}, ${timeText(end)}${changeText(run)}${isOrphan(run) ? "\nthe recording that it is a branch of was deleted" : ""}${run.label?.note ? `\n${run.label.note}` : ""}`;
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
  const several = tree.value.length > 1;
  const { width } = useSize(box, several);
  useEffect(followRuns, []);
  if (!several) return null;
  return html`<section ref=${box} class="branches" aria-label="Branches">
    <button class="bare branches-head" aria-expanded=${open.value} onClick=${() => (open.value = !open.value)}><${Icon} name=${open.value ? "down" : "right"} />${counted(tree.value.filter(({ depth }) => depth > 0).length, "branch", "branches")}</button>
    ${open.value ? html`<ul>${tree.value.map(({ run, depth }) => html`<${Row} key=${run.id} run=${run} depth=${depth} width=${width} />`)}</ul>` : null}
  </section>`;
}
