// The controls of the run: on, hold, a step, a cycle, back, again, stop; and how fast.

import { html } from "../vendor/preact.js";
import { bindKey, keyText } from "../keys.js";
import { Icon } from "../parts/icon.js";
import { order } from "../server.js";
import { running, session, state } from "../store.js";
import { runUntil } from "./until.js";

/** Speeds as [text, times real time]; null for as fast as possible. */
const SPEEDS = [["1/20 x", 0.05], ["1/10 x", 0.1], ["1/4 x", 0.25], ["1/2 x", 0.5], ["1 x", 1], ["2 x", 2], ["5 x", 5], ["10 x", 10], ["20 x", 20], ["fastest", null]];

/** Whether the run cannot go on from here. */
function isOver() {
  return ["ended", "failed"].includes(state.value?.status) || !session.value?.alive;
}

/** Runs or pauses; a run that is over begins again. */
function toggle() {
  if (!session.value) return;
  order(running.value ? { type: "pause" } : isOver() ? { type: "restart", run: true } : { type: "run" });
}

const BUTTONS = [
  { id: "back", text: "One tick of 10 ms back", key: "ArrowLeft", what: { type: "back" } },
  { id: "step", text: "One tick of 10 ms", key: "ArrowRight", what: { type: "step" } },
  { id: "cycle", text: "Until the next production fires", key: "c", what: { type: "cycle" } },
  { id: "restart", text: "Restart with the same seed", key: "r", what: { type: "restart" } },
  { id: "new-seed", icon: "seed", text: "Restart with a new seed", key: "Shift+r", what: { type: "restart", new_seed: true } },
  { id: "stop", text: "Stop the model, whatever it does", key: "Mod+.", what: { type: "stop" } },
];

bindKey(" ", "Run or pause", toggle);
for (const { key, text, what } of BUTTONS) bindKey(key, text, () => order(what));
bindKey("+", "Faster", () => changeSpeed(1));
bindKey("-", "Slower", () => changeSpeed(-1));

function speedNumber() {
  const wanted = state.value?.wanted ?? null;
  const at = SPEEDS.findIndex(([, factor]) => factor === wanted);
  return at < 0 ? SPEEDS.length - 1 : at;
}

function changeSpeed(by) {
  order({ type: "speed", factor: SPEEDS[Math.max(0, Math.min(SPEEDS.length - 1, speedNumber() + by))][1] });
}

export function Transport() {
  const goes = running.value;
  const there = Boolean(session.value);
  const over = isOver();
  const { alive, loading } = session.value ?? {};
  const idle = { step: over, cycle: over, back: !alive || !state.value?.time, stop: !alive && !loading };
  const text = goes ? "Pause" : there && over && !loading ? "Run again" : "Run";
  return html`<div class="transport" role="toolbar" aria-label="Run">
    <button id="run" class="primary" disabled=${!there || loading} title="${text} (Space)" onClick=${toggle}>
      <${Icon} name=${goes ? "pause" : "run"} />${text}
    </button>
    ${BUTTONS.map(
      ({ id, icon, text, key, what }) => html`<button
        key=${id}
        id=${id}
        class="bare"
        disabled=${idle[id] ?? !there}
        title="${text} (${keyText(key)})"
        aria-label=${text}
        onClick=${() => order(what)}
      >
        <${Icon} name=${icon ?? id} />
      </button>`,
    )}
    <button id="until" class="bare" disabled=${!there || over} title="Run until … (U)" aria-label="Run until" onClick=${runUntil}><${Icon} name="until" /></button>
    <select aria-label="Speed" title="How fast it goes at most, in times real time (+ and -)" value=${String(speedNumber())} onChange=${(event) => order({ type: "speed", factor: SPEEDS[event.currentTarget.value][1] })}>
      ${SPEEDS.map(([text], n) => html`<option value=${String(n)}>${text}</option>`)}
    </select>
  </div>`;
}
