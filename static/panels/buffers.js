// The contents of the agents: every buffer with its chunk, every module with its state, by agent; and the result of a run.

import { html, signal, useEffect, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { AtStart } from "../inspector/at_start.js";
import { agentOf, agentsOf, nameIn } from "../inspector/agents.js";
import { useWrittenAgents } from "../inspector/description.js";
import { Flash } from "../inspector/flash.js";
import { Module, Plain, useRequests } from "../inspector/modules.js";
import { Result } from "../inspector/result.js";
import { Icon } from "../parts/icon.js";
import { chunkText, slotsOf, writtenChunk } from "../parts/chunk.js";
import { changesOf, noChange, useChange } from "../changes/changes.js";
import { Problem } from "../parts/problem.js";
import { counted } from "../parts/count.js";
import { nothing, runStatus } from "../run_status.js";
import { running, shownRun, state } from "../store.js";

const LINES = 3; // the number of lines of a chunk shown unless expanded
const KEPT = 1000; // how long a row keeps its height while the run is active [ms]

/** Returns the number of lines that a row needs, up to the limit, and whether there are more. A row that needs fewer lines shrinks:
 * at once if the run is paused; otherwise after a delay, so that what is below does not jump at each retrieval. */
function useLines(text, open) {
  const box = useRef(null);
  const content = useRef(null);
  const [needed, setNeeded] = useState({ lines: 1, more: false });
  const [kept, setKept] = useState(1);
  useLayoutEffect(() => {
    const there = Math.round(content.current.offsetHeight / parseFloat(getComputedStyle(box.current).lineHeight));
    const news = { lines: Math.max(1, Math.min(there, LINES)), more: there > LINES };
    if (news.lines !== needed.lines || news.more !== needed.more) setNeeded(news);
    if (news.lines > kept) setKept(news.lines);
  }, [text, open]);
  useEffect(() => {
    if (needed.lines >= kept) return undefined;
    const timer = setTimeout(() => setKept(needed.lines), running.value ? KEPT : 0);
    return () => clearTimeout(timer);
  }, [needed.lines, kept, running.value]);
  return { box, content, lines: running.value ? kept : needed.lines, more: needed.more };
}

/** The texts that are being written, by run and buffer: {text, from}, with the contents of the buffer when it was begun. A text stays until it
 * is set or cancelled, or the buffer changes; also while another tab is shown. */
const drafts = signal({});

function keyOf(path) {
  return `${shownRun.value} ${path}`;
}

function keepDraft(path, draft) {
  drafts.value = { ...drafts.peek(), [keyOf(path)]: draft };
}

/** The field in which a buffer is edited: Enter sets it, or clears it if it is empty; a problem is shown below.
 * @param chosen Whether the user has just chosen to edit it.
 * @param onLeft Called if it goes away while it has the focus. */
function Edit({ path, name, draft, chosen, onLeft }) {
  const { problem, send, forget } = useChange();
  const line = useRef(null);
  useLayoutEffect(() => {
    if (chosen) line.current.select();
    return () => document.activeElement === line.current && onLeft();
  }, []);
  const done = () => keepDraft(path, undefined);

  async function press(event) {
    event.stopPropagation();
    const text = line.current.value.trim();
    if (event.key === "Escape") done();
    else if (event.key !== "Enter") forget();
    else if (text ? await send("set_buffer", { buffer: path, chunk: text }) : await send("clear_buffer", { buffer: path })) done();
  }

  const write = () => keepDraft(path, { ...draft, text: line.current.value });
  const leave = () => draft.text === draft.from && done();
  return html`<input class="mono edit" ref=${line} aria-label="Chunk of ${name}" aria-invalid=${problem !== null} value=${draft.text} placeholder="empty" maxlength="10000" title="Enter sets the buffer, Escape leaves it unchanged" onInput=${write} onKeyDown=${press} onBlur=${leave} />
    <${Problem} text=${problem} />`;
}

/** A buffer: its chunk, or the field in which it is edited. */
function Buffer({ path, name, chunk }) {
  const row = useRef(null);
  const chosen = useRef(false);
  const text = writtenChunk(chunk);
  const draft = drafts.value[keyOf(path)];
  const edits = draft?.from === text;
  useEffect(() => {
    if (draft && !edits) keepDraft(path, undefined);
  }, [draft, edits]);
  const canEdit = !noChange.value && changesOf("buffer").some(({ word }) => word === "set_buffer");
  const edit = () => {
    if (!canEdit || edits) return;
    chosen.current = true;
    keepDraft(path, { text, from: text });
  };
  const focus = () => requestAnimationFrame(() => row.current?.querySelector(".pen")?.focus());
  return html`<tr ref=${row} data-path=${path} onDblClick=${edit}>
    <th scope="row" class="mono" title=${path}>${name}</th>
    <td class=${edits ? "edits" : ""}>
      ${edits ? html`<${Edit} path=${path} name=${name} draft=${draft} chosen=${chosen.current} onLeft=${focus} />` : html`<${Shown} name=${name} chunk=${chunk} onEdit=${canEdit ? edit : null} />`}
    </td>
  </tr>`;
}

/** The first lines of a chunk, or all of it if expanded. */
function Shown({ name, chunk, onEdit }) {
  const [open, setOpen] = useState(false);
  const slots = slotsOf(chunk);
  const { box, content, lines, more } = useLines(chunkText(chunk), open);
  return html`${onEdit ? html`<button class="bare pen" aria-label="Edit ${name}" title="Edit this buffer (double-click)" onClick=${onEdit}><${Icon} name="pen" /></button>` : null}
    ${more || open
      ? html`<button class="bare" aria-expanded=${open} aria-label="All of ${name}" title=${open ? "A few lines only" : "All of it"} onClick=${() => setOpen(!open)}><${Icon} name="down" /></button>`
      : null}
    <div class="chunk" ref=${box} style=${{ minHeight: `calc(${lines} * var(--row))`, maxHeight: open ? "none" : `calc(${LINES} * var(--row))` }}>
      <div ref=${content}>
        <${Flash} text=${chunk ? "" : "empty"}>${chunk ? null : html`<span class="empty">empty</span>`}<//>
        ${slots.map(([slot, text], n) => html`<${Flash} key=${slot || n} class="slot" text=${text}>${slot ? html`<b>${slot}</b>` : null}${text}<//>`)}
      </div>
    </div>`;
}

function Others({ agent = null, paths, parts }) {
  return html`<div class="others">${paths.map((path) => html`<${Plain} key=${path} path=${path} name=${nameIn(agent, path)} part=${parts[path]} />`)}</div>`;
}

function Agent({ agent, paths, parts, requests, several }) {
  const of = (...kinds) => paths.filter((path) => kinds.includes(parts[path].is));
  const buffers = of("buffer");
  const modules = of("module", "memory", "system");
  const rest = of("part");
  const title = agent ?? "Other parts";
  return html`<section class="agent" aria-label=${title}>
    <h2 class=${several ? "" : "unseen"}>${title}${agent ? html` <span class="quiet">${parts[agent].class}</span>` : null}</h2>
    ${buffers.length
      ? html`<table class="buffers" aria-label="Buffers of ${title}">
          <colgroup><col class="names" /><col /></colgroup>
          <tbody>
            ${buffers.map((path) => html`<${Buffer} key=${path} path=${path} name=${nameIn(agent, path)} chunk=${parts[path].chunk} />`)}
          </tbody>
        </table>`
      : agent ? html`<p class="empty">This agent has no buffers.</p>` : null}
    ${modules.length ? html`<h3>Modules</h3>` : null}
    ${modules.map((path) => html`<${Module} key=${path} path=${path} name=${path === agent ? "productions" : nameIn(agent, path)} part=${parts[path]} request=${requests.get(path)} />`)}
    ${rest.length && agent === null ? html`<${Others} paths=${rest} parts=${parts} />` : null}
    ${rest.length && agent !== null
      ? html`<details class="plain">
          <summary><h3>Other parts <span class="quiet">${rest.length}</span></h3></summary>
          <${Others} agent=${agent} paths=${rest} parts=${parts} />
        </details>`
      : null}
  </section>`;
}

/** The parts of an agent as its text has them, before there is one. */
function WrittenAgent({ agent: { name, parts, productions } }) {
  return html`<section class="agent" aria-label=${name}>
    <h2>${name} <span class="quiet">${counted(productions.length, "production")}</span></h2>
    <table class="buffers" aria-label="Parts of ${name}">
      <colgroup><col class="names" /><col /></colgroup>
      <tbody>${parts.map((part) => html`<tr key=${part.name}><th scope="row" class="mono">${part.name}</th><td class="quiet">${part.made_by}</td></tr>`)}</tbody>
    </table>
  </section>`;
}

function Buffers() {
  const written = useWrittenAgents();
  const parts = state.value?.parts ?? {};
  const paths = Object.keys(parts);
  const busy = paths.filter((path) => parts[path].state?.busy === true);
  const requests = useRequests(busy);
  if (written.length > 0) return html`<div class="agent-parts"><p class="at-start quiet">These are in its text. ${runStatus.value.text}</p>${written.map((agent) => html`<${WrittenAgent} key=${agent.name} agent=${agent} />`)}</div>`;
  if (paths.length === 0) return html`<p class="empty">${nothing("This model has no agent to look into.")}</p>`;
  const agents = agentsOf(parts);
  const groups = [...agents, null]
    .map((agent) => [agent, paths.filter((path) => agentOf(path, agents) === agent)])
    .filter(([, own]) => own.length > 0);
  return html`<div class="agent-parts" key=${shownRun.value}>
    <${AtStart} />
    ${state.value.result ? html`<${Result} result=${state.value.result} />` : null}
    ${groups.map(([agent, own]) => html`<${Agent} key=${agent} agent=${agent} paths=${own} parts=${parts} requests=${requests} several=${groups.length > 1} />`)}
  </div>`;
}

export const panel = { id: "buffers", title: "Buffers", order: 2, View: Buffers };
