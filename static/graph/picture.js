// The graph as a picture to save: what the panel shows, drawn on a surface.

import { cut } from "../parts/surface.js";

const COLOURS = { reads: "series-1", writes: "series-2", asks: "series-4", fills: "series-3" }; // as in graph.css
const STEPS = 24; // pieces of straight line per edge
const [PAD, LEGEND, TITLE, BETWEEN] = [8, 24, 24, 16]; // [px]
const HEAD = 6; // the length of an arrow's head [px]

/** Returns the colours of a node: {back, border, text}. */
function lookOf({ classList: is }) {
  if (is.contains("production") && is.contains("on")) return { back: "accent", border: "accent", text: "on-accent" };
  if (is.contains("fired")) return { back: "flash", border: "series-2", text: "text" };
  if (is.contains("wrong")) return { back: "bad-back", border: "bad", text: "text" };
  if (is.contains("on")) return { back: "chosen", border: "accent", text: "text" };
  return { back: is.contains("module") ? "raised" : "panel", border: is.contains("matches") ? "good" : "strong-line", text: "text" };
}

/** Draws an edge: a path «Mx,yCx,y x,y x,y». */
function drawEdge(surface, path) {
  const is = path.classList;
  const [x1, y1, x2, y2, x3, y3, x4, y4] = path.getAttribute("d").match(/-?[\d.]+/g).map(Number);
  const points = Array.from({ length: STEPS + 1 }, (_, n) => {
    const [b, a] = [n / STEPS, 1 - n / STEPS];
    return [a ** 3 * x1 + 3 * a * a * b * x2 + 3 * a * b * b * x3 + b ** 3 * x4, a ** 3 * y1 + 3 * a * a * b * y2 + 3 * a * b * b * y3 + b ** 3 * y4];
  }).flat();
  const [now, stands] = [is.contains("now"), is.contains("chosen") || is.contains("waits")];
  const name = COLOURS[Object.keys(COLOURS).find((kind) => is.contains(kind))];
  surface.line(points, name, { width: now ? 3 : stands ? 1.5 : 1, dash: is.contains("waits") ? [4, 4] : [], alpha: now || stands ? 1 : is.contains("faint") ? 0.1 : 0.45 });
  const back = Math.sign(x3 - x4) * HEAD;
  if (path.hasAttribute("marker-end")) surface.polygon([x4, y4, x4 + back, y4 - HEAD / 2, x4 + back, y4 + HEAD / 2], name);
}

function drawNode(surface, node, [x, y]) {
  const { offsetWidth: width, offsetHeight: height } = node;
  const { back, border, text } = lookOf(node);
  surface.fill(x, y, width, height, back);
  surface.line([x, y, x + width, y, x + width, y + height, x, y + height, x, y], border);
  const lines = [...node.children].map((line, n) => [line.textContent, n === 0 ? { mono: true, bold: node.classList.contains("buffer") } : { mono: line.classList.contains("mono") }]);
  lines.forEach(([words, style], n) => surface.text(cut(words, width - 2 * PAD, style), x + PAD, y + height / 2 + 15 * (n - (lines.length - 1) / 2), n === 0 ? text : "quiet", style));
}

function drawLegend(surface, items) {
  let x = 0;
  for (const item of items) {
    const text = item.textContent;
    surface.line([x, LEGEND / 2 - 4, x + 18, LEGEND / 2 - 4], COLOURS[item.className] ?? "quiet", { width: item.className === "thick" ? 4 : 2 });
    surface.text(text, x + 24, LEGEND / 2 - 4, "quiet");
    x += item.offsetWidth + BETWEEN;
  }
}

/** Returns the graph in an element of the page as a picture, without its name and title: {width, height, draw}. */
export function pictureOfGraph(element) {
  const items = [...element.querySelectorAll(".graph-legend li")];
  const agents = [...element.querySelectorAll(".graph-agent")].map((agent) => ({ nodes: agent.querySelector(".graph-nodes"), title: agent.querySelector("h2") }));
  const titled = agents.length > 1 ? TITLE : 0;
  const height = agents.reduce((sum, { nodes }) => sum + titled + nodes.offsetHeight + BETWEEN, LEGEND);
  const width = Math.max(items.reduce((sum, { offsetWidth }) => sum + offsetWidth + BETWEEN, 0), ...agents.map(({ nodes }) => nodes.offsetWidth));

  function draw(surface) {
    drawLegend(surface, items);
    let top = LEGEND;
    for (const { nodes, title } of agents) {
      if (titled) surface.text(title.textContent, 0, top + TITLE / 2, "text", { bold: true });
      top += titled;
      surface.at(0, top, () => {
        for (const path of nodes.querySelectorAll(".edge")) drawEdge(surface, path);
        for (const head of nodes.querySelectorAll("h3")) surface.text(head.textContent, head.offsetLeft, head.offsetTop + head.offsetHeight / 2, "text", { bold: true });
        for (const node of nodes.querySelectorAll(".node")) drawNode(surface, node, [node.offsetLeft, node.offsetTop]);
      });
      top += nodes.offsetHeight + BETWEEN;
    }
  }

  return { width, height, draw };
}
