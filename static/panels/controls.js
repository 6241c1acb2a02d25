// Run, pause, step, back, speed, time, aperture.

import { el } from "../dom.js";
import { order } from "../server.js";
import { store, watch } from "../store.js";

const SPEEDS = [["1/20", 0.05], ["1/4", 0.25], ["1", 1], ["2", 2], ["5", 5], ["20", 20], ["fastest", null]];

export function controls(root) {
  const run = el("button", { id: "run", onclick: () => order({ type: store.state?.status === "running" ? "pause" : "run" }) }, "run");
  const button = (id, text, what, title) => el("button", { id, title, onclick: () => order(what) }, text);
  const speed = el("select", { ariaLabel: "Speed", onchange: () => order({ type: "speed", factor: SPEEDS[speed.selectedIndex][1] }) });
  speed.append(...SPEEDS.map(([text]) => el("option", {}, text)));
  speed.selectedIndex = SPEEDS.length - 1;
  const time = el("output", { id: "time" });
  const measured = el("output", { id: "measured" });
  const status = el("span", { id: "status", role: "status" });
  const aperture = el("input", { id: "aperture", type: "range", min: 0, max: 200, step: 1, oninput: slide });
  const width = el("output", { id: "width" });
  const apertureBox = el("label", { hidden: true }, "aperture ", aperture, width);
  root.append(
    run,
    button("step", "step", { type: "step" }, "One tick of 10 ms"),
    button("cycle", "cycle", { type: "cycle" }, "Until the next production fires"),
    button("back", "back", { type: "back" }, "One tick back"),
    button("restart", "restart", { type: "restart" }, "Again with the same seed"),
    button("new-seed", "new seed", { type: "restart", new_seed: true }, "Again with another seed"),
    button("stop", "stop", { type: "stop" }, "End the model, whatever it does"),
    el("label", {}, "speed ", speed),
    time,
    measured,
    apertureBox,
    status,
  );

  let sliding = 0;
  function slide() {
    sliding = performance.now();
    width.value = `${aperture.value} cm`;
    const name = Object.keys(store.state?.apertures ?? {})[0];
    if (name) order({ type: "aperture", width: aperture.value / 100, name });
  }

  watch(["state", "session"], () => {
    const { state, session } = store;
    run.textContent = state?.status === "running" ? "pause" : "run";
    time.value = state ? `t = ${state.time.toFixed(2)} s` : "";
    measured.value = state?.measured ? `${state.measured.toFixed(1)}x` : "";
    const stuck = session?.stuck ? ` (busy${session.stuck.line ? ` at line ${session.stuck.line}` : ""})` : "";
    status.textContent = session?.loading ? "loading …" : state ? `${state.status}${state.reason ? `: ${state.reason}` : ""}${stuck}` : "";
    const names = Object.entries(state?.apertures ?? {});
    apertureBox.hidden = names.length === 0;
    if (names.length && performance.now() - sliding > 500) {
      const free = names[0][1];
      aperture.value = Math.round(100 * free);
      const shoulders = Object.values(session?.world?.bodies ?? {}).map((body) => body.shoulders).find((one) => one);
      width.value = `${(100 * free).toFixed(0)} cm${shoulders ? `  A/S ${(free / shoulders).toFixed(2)}` : ""}`;
    }
  });
}
