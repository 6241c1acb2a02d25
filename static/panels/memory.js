// The chunks of a memory, with their activations and what these are made of.

import { el } from "../dom.js";
import { say } from "../server.js";
import { store, watch } from "../store.js";

export function memory(root) {
  const choice = el("select", { ariaLabel: "Memory", onchange: ask });
  const words = el("input", { type: "search", placeholder: "search", ariaLabel: "Search the memory", oninput: ask });
  const table = el("table");
  const box = el("div", { hidden: true }, el("h2", {}, "Memory"), choice, words, table);
  root.append(box);
  let asking = false;

  async function ask() {
    if (asking || !choice.value || store.state?.status === "running" || !store.session?.alive) return;
    asking = true;
    try {
      const { rows } = await say({ type: "memory", memory: choice.value, words: words.value });
      table.replaceChildren(
        ...rows.map((row) =>
          el(
            "tr",
            { title: Object.entries(row.parts).map(([name, value]) => `${name} ${value === null ? "not known" : value.toFixed(3)}`).join("\n") },
            el("td", {}, row.chunk),
            el("td", {}, row.activation === null ? "?" : row.activation.toFixed(3)),
          ),
        ),
      );
    } catch {
      table.replaceChildren();
    }
    asking = false;
  }

  watch(["state"], () => {
    const paths = Object.entries(store.state?.parts ?? {}).filter(([, part]) => part.is === "memory").map(([path]) => path);
    box.hidden = paths.length === 0;
    if (paths.join() !== [...choice.options].map((option) => option.value).join()) choice.replaceChildren(...paths.map((path) => el("option", {}, path)));
    ask();
  });
}
