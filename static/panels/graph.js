// The graph of each agent: productions, the buffers that they read and write, the modules that they ask, and what flows at this moment.

import { html, signal, useRef } from "../vendor/preact.js";
import { agentsOf, isBelow, nameIn, productionKey } from "../inspector/agents.js";
import { at, explainProduction } from "../inspector/explanation.js";
import { flows, justNow } from "../graph/flows.js";
import { edgePath, placed } from "../graph/layout.js";
import { pictureOfGraph } from "../graph/picture.js";
import { openTab } from "../open_tab.js";
import { useAnswer } from "../parts/answer.js";
import { chunkText } from "../parts/chunk.js";
import { SaveButtons } from "../parts/save_buttons.js";
import { useSize } from "../parts/size.js";
import { pictureName, runName, savePicture } from "../parts/picture.js";
import { nothing } from "../run_status.js";
import { period, running, session, state } from "../store.js";

const QUESTION = { type: "explain" };
/** The kinds of edges, and what their ends are. */
const KINDS = { reads: "read", writes: "written", asks: "asked", fills: "filled" };
const HEADS = ["Modules", "Buffers", "Productions"];
const MARGIN = 24; // left and right of the graph [px]

/** The node whose edges stand out: its id; null for none. */
const chosen = signal(null);

/** Returns the buffers that a production reads, as paths, from its conditions: `goal: task:count`. */
function readsOf(reason, agent, buffers) {
  const names = (reason?.conditions ?? []).map(({ condition }) => condition.split(":", 1)[0].trim());
  return buffers.filter((path) => names.includes(nameIn(agent, path)) || names.includes(path));
}

/** Returns the graph of an agent: {columns, edges}, with edges [{from, to, kind, flows}]. */
function graphOf(agent, parts, reasons) {
  const own = Object.keys(parts).filter((path) => path === agent || isBelow(path, agent));
  const systems = own.filter((path) => parts[path].is === "system");
  const buffers = own.filter((path) => parts[path].is === "buffer");
  const modules = own.filter((path) => ["module", "memory"].includes(parts[path].is));
  const productions = systems.flatMap((system) => parts[system].productions.map((name) => ({ id: productionKey(system, name), system, name })));
  const belongs = new Set(own);
  const { fired, answered } = justNow(period.value, (source) => belongs.has(source));
  const known = flows();
  const there = new Set([...buffers, ...modules]);
  const edges = [];
  for (const { id, system, name } of productions) {
    const reason = reasons.get(id);
    const isNext = parts[system].chosen === name;
    const read = readsOf(reason, agent, buffers);
    edges.push(...read.map((path) => ({ from: path, to: id, kind: "reads", flows: isNext })));
    for (const path of known.changedBy(id)) {
      if (there.has(path)) edges.push({ from: id, to: path, kind: buffers.includes(path) ? "writes" : "asks", flows: fired === id });
    }
  }
  for (const module of modules) {
    const waits = parts[module].state?.busy === true;
    for (const path of known.feeds.get(module) ?? []) {
      if (there.has(path)) edges.push({ from: module, to: path, kind: "fills", flows: answered.has(module), waits });
    }
  }
  return { columns: [modules, buffers, productions.map(({ id }) => id)], productions, edges, fired };
}

/** Returns what a node reads, writes, asks or fills, as text. */
function sentence(id, edges, nameOf) {
  const list = (found) => [...new Set(found)].map(nameOf).join(", ");
  const parts = Object.entries(KINDS).flatMap(([kind, past]) => {
    const to = list(edges.filter((edge) => edge.kind === kind && (kind === "reads" ? edge.to : edge.from) === id).map((edge) => (kind === "reads" ? edge.from : edge.to)));
    const by = list(edges.filter((edge) => edge.kind === kind && (kind === "reads" ? edge.from : edge.to) === id).map((edge) => (kind === "reads" ? edge.to : edge.from)));
    return [...(to ? [`${kind} ${to}`] : []), ...(by ? [`is ${past} by ${by}`] : [])];
  });
  return parts.join("; ") || "nothing flows to or from it, as far as the run has shown";
}

function Edges({ graph, layout }) {
  const rank = ({ flows: now, from, to }) => (now ? 2 : chosen.value === from || chosen.value === to ? 1 : 0);
  const ordered = graph.edges.toSorted((one, other) => rank(one) - rank(other));
  return html`<svg width=${layout.width} height=${layout.height} aria-hidden="true" focusable="false">
    <defs>
      ${Object.keys(KINDS).map((kind) => html`<marker key=${kind} id="arrow-${kind}" viewBox="0 0 6 6" refX="5.5" refY="3" markerWidth="7" markerHeight="7" markerUnits="userSpaceOnUse" orient="auto"><path class=${kind} d="M0,0.5 6,3 0,5.5z" /></marker>`)}
    </defs>
    ${ordered.map(({ from, to, kind, flows: now, waits }) => html`<path
        key=${`${from} ${to} ${kind}`}
        class="edge ${kind} ${now ? "now" : ""} ${waits ? "waits" : ""} ${chosen.value === null ? "" : chosen.value === from || chosen.value === to ? "chosen" : "faint"}"
        d=${edgePath(layout.nodes.get(from), layout.nodes.get(to), kind === "reads" || kind === "fills" ? -3 : 3)}
        marker-end=${now || chosen.value === from || chosen.value === to ? `url(#arrow-${kind})` : undefined}
      />`)}
  </svg>`;
}

/** Returns the node that an arrow key leads to: the next of the column, or the nearest of the next column that has any. */
function neighbour(key, id, columns, nodes) {
  const n = columns.findIndex((column) => column.includes(id));
  const step = { ArrowDown: 1, ArrowUp: -1 }[key];
  if (step) return columns[n][columns[n].indexOf(id) + step];
  const others = key === "ArrowLeft" ? columns.slice(0, n).reverse() : columns.slice(n + 1);
  const middle = (one) => nodes.get(one).y + nodes.get(one).height / 2;
  const away = (one) => Math.abs(middle(one) - middle(id));
  return others.find((column) => column.length > 0)?.toSorted((one, other) => away(one) - away(other))[0];
}

const ARROWS = ["ArrowDown", "ArrowUp", "ArrowLeft", "ArrowRight"];

function Agent({ agent, parts, reasons, width, several }) {
  const graph = graphOf(agent, parts, reasons);
  const layout = placed(width, graph.columns);
  const names = new Map(graph.productions.map(({ id, name }) => [id, name]));
  const nameOf = (id) => names.get(id) ?? nameIn(agent, id);
  const ids = graph.columns.flat();
  const inHand = ids.includes(chosen.value) ? chosen.value : ids[0];

  function press(event) {
    const leaves = event.key === "Escape" && chosen.value !== null;
    if (!leaves && !ARROWS.includes(event.key)) return;
    event.preventDefault();
    const to = leaves ? null : neighbour(event.key, inHand, graph.columns, layout.nodes);
    if (to === undefined) return;
    chosen.value = to;
    if (to !== null) event.currentTarget.querySelector(`[data-node="${CSS.escape(to)}"]`).focus();
  }

  function node(id, kind, more, title, before = null) {
    const { x, y, width: wide, height } = layout.nodes.get(id);
    return html`<button
      key=${id}
      data-node=${id}
      class="node ${kind}"
      tabindex=${id === inHand ? 0 : -1}
      aria-pressed=${chosen.value === id}
      title=${title}
      style=${{ left: `${x}px`, top: `${y}px`, width: `${wide}px`, height: `${height}px` }}
      onClick=${() => (chosen.value = chosen.value === id ? null : id)}
    ><span class="name mono">${before}${nameOf(id)}</span>${more}</button>`;
  }

  const [modules, buffers] = graph.columns;
  return html`<section class="graph-agent" aria-label=${agent}>
    <h2 class=${several ? "" : "unseen"}>${agent}</h2>
    <div class="graph-nodes" role="group" aria-label="Graph of ${agent}" style=${{ width: `${layout.width}px`, height: `${layout.height}px` }} onKeyDown=${press}>
      <${Edges} graph=${graph} layout=${layout} />
      ${HEADS.map((text, n) => (graph.columns[n].length > 0 ? html`<h3 key=${text} style=${{ left: `${layout.heads[n]}px` }}>${text}</h3>` : null))}
      ${modules.map((path) => {
        const { busy, error } = parts[path].state ?? {};
        const text = error === true ? "error" : busy === true ? "busy" : parts[path].class;
        return node(path, `module ${busy === true ? "on" : ""} ${error === true ? "wrong" : ""}`, html`<span class="content">${text}</span>`, `${path}: ${text}`);
      })}
      ${buffers.map((path) => {
        const text = chunkText(parts[path].chunk) || "empty";
        return node(path, "buffer", html`<span class="content mono ${parts[path].chunk ? "" : "quiet"}">${text}</span>`, `${path}: ${text}`);
      })}
      ${graph.productions.map(({ id, system, name }) => {
        const isNext = parts[system].chosen === name;
        const matches = !running.value && reasons.get(id)?.matches === true;
        const words = isNext ? "is about to fire" : graph.fired === id ? "has fired" : matches ? "matches" : "";
        const inner = system === agent ? null : html`<span class="system">${nameIn(agent, system)}.</span>`;
        return node(id, `production ${isNext ? "on" : graph.fired === id ? "fired" : matches ? "matches" : ""}`, null, `${system}: ${name}${words ? `: ${words}` : ""}`, inner);
      })}
    </div>
    ${ids.includes(chosen.value)
      ? html`<p class="graph-text" role="status">
          <b class="mono">${nameOf(chosen.value)}</b> ${sentence(chosen.value, graph.edges, nameOf)}
          ${names.has(chosen.value) ? html`<button onClick=${() => explain(graph.productions.find(({ id }) => id === chosen.value))}>Why</button>` : null}
        </p>`
      : null}
  </section>`;
}

/** Explains a production in its own panel. */
function explain({ system, name }) {
  at.value = null;
  explainProduction(system, name);
  openTab.value = "productions";
}

function Legend() {
  return html`<ul class="graph-legend" aria-label="Edges">
    <li class="reads">a production reads a buffer</li>
    <li class="writes">writes to it in this run</li>
    <li class="asks">asks a module in this run</li>
    <li class="fills">a module fills a buffer in this run</li>
    <li class="thick">now</li>
  </ul>`;
}

/** Saves the graph as it is shown; `kind` is "png" or "svg". */
function save(element, kind) {
  const { model, run, seed } = session.peek();
  const at = `at ${state.peek().time.toFixed(2)} s`;
  savePicture({ ...pictureOfGraph(element), name: pictureName({ model, seed }, `graph ${at}`), title: `Graph ${at}: ${runName({ model, run, seed })}` }, kind);
}

function Graph() {
  const box = useRef(null);
  const { width } = useSize(box);
  const { answer } = useAnswer(QUESTION, { once: true });
  const parts = state.value?.parts ?? {};
  const agents = agentsOf(parts);
  const reasons = new Map((answer ?? []).flatMap((one) => one.productions).map((reason) => [productionKey(reason.system, reason.name), reason]));
  return html`<div class="graph" ref=${box}>
    ${agents.length === 0 ? html`<p class="empty">${nothing("This model has no agent: there is nothing to draw.")}</p>` : html`<div class="graph-head">
      <${Legend} />
      <${SaveButtons} what="graph" save=${(kind) => save(box.current, kind)} />
    </div>`}
    ${width > 0 ? agents.map((agent) => html`<${Agent} key=${agent} agent=${agent} parts=${parts} reasons=${reasons} width=${width - 2 * MARGIN} several=${agents.length > 1} />`) : null}
  </div>`;
}

export const panel = { id: "graph", title: "Graph", order: 5.5, View: Graph };
