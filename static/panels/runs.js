// The recordings, with their settings and results; to open, run again, compare, delete, download.

import { html, useEffect, useMemo, useSignal } from "../vendor/preact.js";
import { command } from "../commands.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { Problem } from "../parts/problem.js";
import { wordsOf } from "../parts/words.js";
import { SelectedRuns } from "../runs/selected_runs.js";
import { goToTab } from "../open_tab.js";
import { addFiles, chooseFiles, deleteRuns, openRun } from "../runs/actions.js";
import { followRuns, listRuns, loading, problem, runs as list, total, warning } from "../runs/list.js";
import { session } from "../store.js";
import { chosen, sorted, Table } from "../runs/table.js";
import { textOf } from "../runs/wording.js";

command({ text: "Compare, name or delete recordings: open their list", group: "Panels", work: () => goToTab("runs"), needs: "models folder" });

command({ text: "Open a recording file …", group: "Run", work: chooseFiles, needs: "models folder" });

/** Returns the recordings that contain every word of a search. */
function found(all, search) {
  const words = wordsOf(search);
  if (words.length === 0) return all;
  return all.filter((run) => {
    const text = textOf(run);
    return words.every((word) => text.includes(word));
  });
}

/** Returns whether nothing was ever run in a recording, for example of a model that was only opened. */
function isIdle(run) {
  return run.time === 0 && !run.ended && !run.failed && !run.session && !run.problem;
}

function Runs() {
  const search = useSignal("");
  const withIdle = useSignal(false);
  const dropping = useSignal(false); // whether files are held over the list
  useEffect(followRuns, []);
  const whole = list.value ?? [];
  const all = useMemo(() => (withIdle.value ? whole : whole.filter((run) => !isIdle(run))), [whole, withIdle.value]);
  const idle = whole.length - all.length;
  const shown = useMemo(() => found(all, search.value), [all, search.value]);
  const ordered = sorted(shown);
  const picked = ordered.filter((run) => chosen.value.has(run.id));

  function press(event) {
    if (event.target.tagName === "INPUT" && event.target.type === "search") return;
    if (event.key === "Delete" && picked.length > 0) deleteRuns(picked);
    else if (event.key === "Enter" && event.target.type === "checkbox" && picked.length === 1) openRun(picked[0]);
    else return;
    event.preventDefault();
  }

  function over(event) {
    if (!event.dataTransfer.types.includes("Files")) return;
    event.preventDefault(); // otherwise the browser shows the file itself
    dropping.value = true;
  }
  const leave = (event) => event.currentTarget.contains(event.relatedTarget) || (dropping.value = false);
  function drop(event) {
    over(event);
    dropping.value = false;
    addFiles([...event.dataTransfer.files]);
  }

  return html`<div class="runs ${dropping.value ? "dropping" : ""}" onKeyDown=${press} onDragOver=${over} onDragLeave=${leave} onDrop=${drop}>
    <div class="tools">
      <input type="search" aria-label="Search recordings" placeholder="Search: model, parameter, outcome …" value=${search.value} onInput=${(event) => (search.value = event.currentTarget.value)} />
      <span class="quiet number" role="status">${countText(shown.length, all.length, whole.length)}</span>
      <button class="bare" title="Add recording files to the list: choose them, or drop them on it" onClick=${chooseFiles}>Add files …</button>
      <button class="bare" title="Read the list again" aria-label="Read the list again" onClick=${listRuns}><${Icon} name="restart" /></button>
    </div>
    ${problem.value ? html`<p class="problem bad" role="alert">The recordings cannot be listed: ${problem.value} <button onClick=${listRuns}>Try again</button></p>` : null}
    <${Problem} text=${warning.value} />
    ${body(all, ordered, search)}
    ${idle > 0 ? html`<p class="left-out">${counted(idle, "recording")} without a step ${idle === 1 ? "is" : "are"} not listed <button class="bare" onClick=${() => (withIdle.value = true)}>Show</button></p>` : null}
    <${SelectedRuns} list=${picked} />
  </div>`;
}

function body(all, ordered, search) {
  if (list.value === null) return html`<p class="empty runs-list" role="status">${problem.value ? "" : "Reading the recordings …"}</p>`;
  if (all.length === 0) return html`<p class="empty runs-list">${session.value?.not_kept ?? "No recordings yet. Press Run: each run is recorded, and listed here."}</p>`;
  if (ordered.length > 0) return html`<${Table} list=${ordered} open=${openRun} />`;
  return html`<p class="empty runs-list">No recording has all these words. <button onClick=${() => (search.value = "")}>Show all</button></p>`;
}

function countText(shown, known, read) {
  if (loading.value && read < total.value) return `reading ${read} of ${total.value} …`;
  return shown === known ? `${known}` : `${shown} of ${known}`;
}

export const panel = { id: "runs", title: "Runs", order: 8, View: Runs, needs: "models folder" };
