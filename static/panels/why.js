// Why, and why not: every production at this moment, and the last retrievals.

import { el } from "../dom.js";
import { say } from "../server.js";
import { store, watch } from "../store.js";

export function why(root) {
  const text = el("pre", { id: "why-text" });
  root.append(el("h2", {}, "Why"), text);
  let asking = false;
  watch(["state"], async () => {
    if (asking || !store.state || store.state.status === "running" || !store.session?.alive) return;
    asking = true;
    try {
      const agents = await say({ type: "explain" });
      const lines = agents.flatMap((agent) => [
        `${agent.agent} at ${agent.time.toFixed(3)} s`,
        ...agent.productions.map((reason) => reason.text),
        ...agent.retrievals.map((reason) => reason.text),
      ]);
      text.textContent = lines.join("\n");
    } catch (error) {
      text.textContent = error.message;
    }
    asking = false;
  });
}
