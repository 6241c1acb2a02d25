// The table of recordings: draws only the visible rows, so that thousands cost no more than a few.

import { html, signal, useLayoutEffect, useRef, useSignal } from "../vendor/preact.js";
import { timeText } from "../parts/units.js";
import { useVisible } from "../parts/visible.js";
import { remembered } from "../local_storage.js";
import { alive, session, shownRecording, state } from "../store.js";
import { useRowInView } from "./row_in_view.js";
import { agoText, branchText, differentText, endedText, firstMeasure, nameOf, originText, outcomeText, ownName, resultText, sizeText, whenInFull, whenText } from "./wording.js";

const ROW = 44; // [px]; panels/runs.css has the same
const MAX_DIGITS = 19; // of a seed: aligned to the right, texts of numbers are in the order of the numbers
const AROUND = 12; // the number of rows drawn beyond the visible ones

/** The sort keys: their column headings, and the values to compare. */
const KEYS = {
  made: { column: "when", text: "Began", of: (run) => run.made },
  model: { column: "model", text: "Model", of: (run) => run.model },
  seed: { column: "model", text: "Seed", of: (run) => String(run.seed ?? "").padStart(MAX_DIGITS) },
  outcome: { column: "outcome", text: "Outcome", of: (run) => `${outcomeText(run)} ${(firstMeasure(run)?.[1] ?? 0).toFixed(2).padStart(9, "0")}` },
  ended: { column: "outcome", text: "End", of: endedText },
  time: { column: "time", text: "Time", of: (run) => run.time },
  size: { column: "time", text: "Size", of: (run) => run.size },
};
const COLUMNS = [...new Set(Object.values(KEYS).map(({ column }) => column))];

const order = remembered("runs sorted", { by: "made", down: true });
/** The ids of the chosen recordings. */
export const chosen = signal(new Set());

/** Returns recordings in the order that the user has chosen. */
export function sorted(list) {
  const { of } = KEYS[order.value.by] ?? KEYS.made;
  const sign = order.value.down ? -1 : 1;
  return list.toSorted((one, other) => {
    const [a, b] = [of(one), of(other)];
    return sign * (a < b ? -1 : a > b ? 1 : 0) || other.made - one.made;
  });
}

function sortBy(key) {
  const { by, down } = order.value;
  order.value = { by: key, down: by === key ? !down : ["made", "time", "size"].includes(key) };
}

function Head({ column }) {
  const keys = Object.entries(KEYS).filter(([, key]) => key.column === column);
  const { by, down } = order.value;
  const here = keys.some(([key]) => key === by);
  return html`<th scope="col" class=${column} aria-sort=${here ? (down ? "descending" : "ascending") : "none"}>
    <div>${keys.map(
      ([key, { text }]) => html`<button class="bare" key=${key} aria-label="Sort by ${text.toLowerCase()}" onClick=${() => sortBy(key)}>
        ${text}<span class="arrow" aria-hidden="true">${key === by ? (down ? "▾" : "▴") : ""}</span>
      </button>`,
    )}</div>
  </th>`;
}

/** The length of a run; for the current run, it grows. */
function Length({ run }) {
  const goesOn = alive.value && run.session === session.value.id && run.id === session.value.recording;
  return timeText(goesOn ? state.value.furthest : run.time);
}

function Row({ run, list, number, now, toggle, open }) {
  const isChosen = chosen.value.has(run.id);
  const own = run.id === shownRecording.value;
  const different = differentText(run);
  const name = ownName(run);
  const { tags = [] } = run.label ?? {};
  const row = useRef(null);
  // A row that leaves the list, such as one that is deleted, passes the focus on; a row that has it is drawn wherever the list is scrolled to.
  useLayoutEffect(
    () => () => {
      if (!row.current.contains(document.activeElement)) return;
      const rows = [...row.current.parentElement.querySelectorAll("[data-run]")];
      const at = rows.indexOf(row.current);
      (rows[at + 1] ?? rows[at - 1] ?? row.current.closest(".runs")).querySelector("input").focus(); // without a row, the search
    },
    [],
  );
  return html`<tr
    ref=${row}
    class="${isChosen ? "chosen" : ""} ${own ? "present" : ""}"
    aria-selected=${isChosen}
    aria-rowindex=${number + 2}
    data-run=${run.id}
    onClick=${(event) => toggle(run.id, event)}
    onDblClick=${() => open(run)}
  >
    <td class="pick">
      <input type="checkbox" checked=${isChosen} aria-label="Choose ${nameOf(run)}" onClick=${(event) => { event.stopPropagation(); toggle(run.id, event, true); }} />
    </td>
    <td class="when" title=${whenInFull(run.made)}><span class="number">${whenText(run.made)}</span><small>${agoText(run.made, now)}</small></td>
    <td class="model" title=${[name, run.model || run.id, tags.join(", "), different, `seed ${run.seed}`].filter(Boolean).join("\n")}>
      <span class="names">
        ${name ? html`<b>${name}</b>` : null}<span class=${name ? "path quiet" : "path"}><bdi>${run.model || run.id}</bdi></span>
        ${tags.map((tag) => html`<span key=${tag} class="tag">${tag}</span>`)}
      </span>
      <small>${own || run.session ? html`<b class="present-mark" title=${own ? "The run that is shown" : "A session that is open still writes it"}>${own ? "present" : "open"}</b> · ` : null}${run.problem ? "" : html`${run.branched === null ? null : html`<b title="branch ${originText(run, list)}">${branchText(run)}</b> · `}${different ? html`<span class="mono">${different}</span> · ` : ""}seed ${String(run.seed ?? "–")}`}</small>
    </td>
    <td class="outcome ${run.problem || run.failed ? "bad" : ""}" title=${endedText(run)}>
      <span>${outcomeText(run)} <span class="number">${resultText(run)}</span></span><small>${endedText(run)}</small>
    </td>
    <td class="time number"><span>${run.problem ? "" : html`<${Length} run=${run} />`}</span><small>${sizeText(run.size)}</small></td>
  </tr>`;
}

/**
 * @param list The recordings in order.
 * @param open Called with a recording to open.
 */
export function Table({ list, open }) {
  const box = useRef(null);
  const ids = list.map((run) => run.id);
  const row = useRowInView(box, ids, chosen.value, shownRecording.value, ROW);
  const seen = useVisible(box, row.resized);
  const now = useSignal(Date.now() / 1000);
  const last = useRef(null);
  const focused = useSignal(null); // the id of the run whose row had the focus last
  const spot = useRef(-1); // the number of that row, also once it is deleted

  useLayoutEffect(() => {
    const place = box.current;
    place.addEventListener("focusin", ({ target }) => (focused.value = target.closest("[data-run]")?.dataset.run ?? null));
    const clock = setInterval(() => (now.value = Date.now() / 1000), 20_000);
    return () => clearInterval(clock);
  }, []);

  const [first, beyond] = seen.range(list.length, ROW, AROUND);
  const kept = list.findIndex((run) => run.id === focused.value);
  if (kept >= 0) spot.current = kept;
  // The rows before and after it are drawn too, for the keys that lead to them; when it is deleted, one of them gets the focus.
  const near = focused.value === null ? [] : [-1, 0, 1].map((step) => spot.current + step).filter((number) => list[number]);
  const drawn = [...new Set([...list.slice(first, beyond).map((_, n) => first + n), ...near])].sort((one, other) => one - other);
  // The key of a space is that of the row after it: no row is moved in the page when others come or go, which would take its focus away.
  const space = (rows, key) => html`<tr class="space" key="before ${key}" aria-hidden="true" style=${{ height: `${rows * ROW}px` }}></tr>`;

  /** Chooses a single row; with Ctrl, or its checkbox, in addition to others; with Shift, a range. */
  function toggle(id, event, besides = event.ctrlKey || event.metaKey) {
    const from = ids.indexOf(last.current);
    const next = new Set(besides || event.shiftKey ? chosen.value : []);
    if (event.shiftKey && from >= 0) {
      const [a, b] = [from, ids.indexOf(id)].sort((one, other) => one - other);
      for (const each of ids.slice(a, b + 1)) next.add(each);
    } else if (besides && next.has(id)) next.delete(id);
    else next.add(id);
    last.current = id;
    chosen.value = next;
  }

  const all = list.length > 0 && list.every((run) => chosen.value.has(run.id));
  const chooseAll = () => (chosen.value = new Set(all ? [] : list.map((run) => run.id)));

  return html`<div class="runs-list" ref=${box} tabindex="-1" onScroll=${() => (row.scrolled(), seen.look())}>
    <table class="runs-table" aria-label="Recordings" aria-rowcount=${list.length + 1}>
      <thead>
        <tr aria-rowindex="1">
          <th class="pick"><input type="checkbox" aria-label="Choose all that are listed" checked=${all} onClick=${chooseAll} /></th>
          ${COLUMNS.map((column) => html`<${Head} key=${column} column=${column} />`)}
        </tr>
      </thead>
      <tbody>
        ${drawn.map((number, n) => {
          const run = list[number];
          const left = number - (drawn[n - 1] ?? -1) - 1;
          const shown = html`<${Row} key=${run.id} run=${run} list=${list} number=${number} now=${now.value} toggle=${toggle} open=${open} />`;
          return left > 0 ? [space(left, run.id), shown] : [shown];
        }).flat()}
        ${space(list.length - 1 - (drawn.at(-1) ?? -1), "the end")}
      </tbody>
    </table>
  </div>`;
}
