// What every buffer holds, and what every module is like; what changed flashes.

import { chunkText, el } from "../dom.js";
import { store, watch } from "../store.js";

export function buffers(root) {
  const table = el("table");
  const before = new Map();
  root.append(el("h2", {}, "Buffers and modules"), table);
  watch(["state"], () => {
    const rows = [];
    for (const [path, part] of Object.entries(store.state?.parts ?? {})) {
      const text = part.is === "buffer" ? chunkText(part.chunk) : part.is === "part" ? null : stateText(part);
      if (text === null) continue;
      const flash = before.has(path) && before.get(path) !== text;
      before.set(path, text);
      rows.push(el("tr", { className: flash ? "changed" : "" }, el("th", {}, path), el("td", {}, text)));
    }
    table.replaceChildren(...rows);
  });
}

function stateText(part) {
  const told = part.state ?? {};
  const words = part.is === "system" ? [`about to fire: ${part.chosen ?? "nothing"}`] : [];
  if ("busy" in told) words.push(told.busy ? "busy" : "free");
  if (told.error) words.push("error");
  if ("size" in told) words.push(`${told.size} chunks`);
  return words.join(", ");
}
