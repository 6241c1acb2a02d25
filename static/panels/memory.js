// Declarative memory: its chunks with their activations, the body schema in it, and what the eyes found last.

import { html, signal, useEffect, useState } from "../vendor/preact.js";
import { changesOf, noChange, useChange } from "../changes/changes.js";
import { Problem } from "../parts/problem.js";
import { AtStart } from "../inspector/at_start.js";
import { pathsOf } from "../inspector/agents.js";
import { MemoryTable } from "../inspector/memory_table.js";
import { Search } from "../inspector/retrievals.js";
import { postures, SchemaTable } from "../inspector/schema_table.js";
import { Placeholder } from "../inspector/placeholder.js";
import { useAnswer } from "../parts/answer.js";
import { valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { remembered } from "../local_storage.js";
import { nothing } from "../run_status.js";
import { running, shownRun, state } from "../store.js";
import { runTimeText } from "../timeline/seek.js";

const MAX_CHUNKS = 5000; // the maximum number of chunks requested
const LIVE = 150; // a memory with at most this many chunks is also shown while the run is active
const TYPED = 200; // the delay between the last key and the search [ms]

const view = remembered("memory view", "chunks");
const wanted = signal(""); // the chosen memory

function Seen() {
  const result = useAnswer({ type: "explain" });
  const searches = (result.answer ?? []).flatMap((one) => one.searches);
  return html`<div class="reasons-text">
    <${Placeholder} answer=${result} />
    ${result.answer && searches.length === 0 ? html`<p class="empty">There has been no visual search yet.</p>` : null}
    ${searches.map((reason) => html`<${Search} key="${reason.module} ${reason.bottom_up}" reason=${reason} />`)}
  </div>`;
}

function Note({ result, schema }) {
  if (!result.answer) return null;
  const { rows, size, threshold } = result.answer;
  const found = rows.length === size ? counted(size, "chunk") : `${rows.length} of ${counted(size, "chunk")}`;
  const cut = rows.length === MAX_CHUNKS ? "; search for fewer" : "";
  return html`<span class="quiet">${schema ? counted(schema.length, "posture") : `${found}${cut}${threshold === null ? "" : `, threshold ${valueText(threshold)}`}`}</span>`;
}

/** The field in which a chunk is added to the memory: Enter adds it. */
function AddChunk({ memory }) {
  const { problem, send, forget } = useChange();
  if (!changesOf("memory").some(({ word }) => word === "add_chunk")) return null;

  async function press(event) {
    const field = event.currentTarget;
    const chunk = field.value.trim();
    if (event.key !== "Enter") forget();
    else if (chunk && (await send("add_chunk", { memory, chunk }))) field.value = "";
  }

  return html`<input class="mono add-chunk" aria-label="Add a chunk" aria-invalid=${problem !== null} placeholder="Add a chunk, such as item:cup" title=${noChange.value || "Enter adds it, or strengthens the equal chunk that is there"} maxlength="10000" disabled=${Boolean(noChange.value)} onKeyDown=${press} />
    <${Problem} text=${problem} />`;
}

function Chunks({ memory, schema }) {
  const [typed, setTyped] = useState("");
  const [words, setWords] = useState("");
  useEffect(() => {
    const timer = setTimeout(() => setWords(typed.trim()), TYPED);
    return () => clearTimeout(timer);
  }, [typed]);
  const size = state.value?.parts[memory]?.state.size ?? 0;
  const live = size <= LIVE;
  const result = useAnswer({ type: "memory", memory, words: words.slice(0, 200), most: MAX_CHUNKS }, { live, once: true });
  const mine = result.answer?.memory === memory ? result.answer : null;
  const found = schema && mine ? postures(mine.rows) : null;
  return html`<div class="tools">
      <input type="search" aria-label="Search the memory" placeholder="Search" value=${typed} onInput=${(event) => setTyped(event.currentTarget.value)} />
      <${Note} result=${result} schema=${found} />
      ${schema ? null : html`<${AddChunk} memory=${memory} />`}
      ${running.value && !live && mine ? html`<span class="quiet" role="status">as it was at ${runTimeText(result.time, 3)}</span>` : null}
    </div>
    <${Placeholder} answer=${mine ? { ...result, waiting: false } : result} />
    ${mine && !schema ? html`<${MemoryTable} answer=${mine} words=${words} />` : null}
    ${found?.length ? html`<${SchemaTable} rows=${found} />` : null}
    ${found && found.length === 0 ? html`<p class="empty">${words ? "No posture has all of these words." : "No posture has been felt yet: the body schema grows as the body moves."}</p>` : null}`;
}

function Memory() {
  const parts = state.value?.parts ?? {};
  const memories = pathsOf(parts, "memory");
  const eyes = Object.values(parts).some((part) => part.is === "module" && "watching" in (part.state ?? {}));
  const moves = Object.values(parts).some((part) => part.is === "module" && "size_grid" in (part.state ?? {}));
  if (memories.length === 0 && !eyes) return html`<p class="empty">${nothing("This model has no declarative memory.")}</p>`;
  const views = [
    ...(memories.length ? [{ id: "chunks", text: "Chunks" }] : []),
    ...(memories.length && moves ? [{ id: "schema", text: "Body schema" }] : []),
    ...(eyes ? [{ id: "seen", text: "Seen" }] : []),
  ];
  const shown = views.some(({ id }) => id === view.value) ? view.value : views[0].id;
  const memory = memories.includes(wanted.value) ? wanted.value : memories[0];
  return html`<div class="memory" key=${shownRun.value}>
    <${AtStart} />
    ${views.length > 1 || memories.length > 1
      ? html`<div class="tools heads">
          ${views.length > 1
            ? html`<div class="choices" role="group" aria-label="What is shown">
                ${views.map(({ id, text }) => html`<button key=${id} aria-pressed=${shown === id} onClick=${() => (view.value = id)}>${text}</button>`)}
              </div>`
            : null}
          ${memories.length > 1 && shown !== "seen"
            ? html`<select aria-label="Memory" value=${memory} onChange=${(event) => (wanted.value = event.currentTarget.value)}>
                ${memories.map((path) => html`<option key=${path} value=${path}>${path}</option>`)}
              </select>`
            : null}
        </div>`
      : null}
    ${shown === "seen" ? html`<${Seen} />` : html`<${Chunks} key=${memory} memory=${memory} schema=${shown === "schema"} />`}
  </div>`;
}

export const panel = { id: "memory", title: "Memory", order: 4, View: Memory };
