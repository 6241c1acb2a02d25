// The latest events: what fired, and what the model printed.

import { el } from "../dom.js";
import { store, watch } from "../store.js";

const SHOWN = new Set(["fire", "output", "reward", "compile", "command"]);
const MOST = 200;

export function firings(root) {
  const table = el("table", { id: "events" });
  const gap = el("p", { className: "warning" });
  root.append(el("h2", {}, "Productions"), gap, table);
  watch(["events"], () => {
    gap.textContent = store.missing ? `${store.missing} earlier events are not shown here.` : "";
    const rows = [];
    for (let n = store.events.length - 1; n >= 0 && rows.length < MOST; n -= 1) {
      const [time, source, kind, data] = store.events[n];
      if (SHOWN.has(kind)) rows.push(el("tr", {}, el("td", {}, (time / 1e6).toFixed(3)), el("td", {}, source), el("td", {}, text(kind, data))));
    }
    table.replaceChildren(...rows);
  });
}

function text(kind, data) {
  if (kind === "fire") return `${data.production}${Object.entries(data.bound ?? {}).map(([name, value]) => `  ?${name}=${value}`).join("")}`;
  if (kind === "output") return `prints: ${data.text}`;
  return `${kind} ${JSON.stringify(data)}`;
}
