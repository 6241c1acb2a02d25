// The controls of the run: run, pause, tick, cycle, back, restart, stop; and its speed.

import { html } from "../vendor/preact.js";
import { command, commandsOf, run } from "../commands.js";
import { keyText, buttonTitle } from "../keys.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { optimistic } from "../parts/optimistic_value.js";
import { isAvailable } from "../needs.js";
import { request, sendCommand } from "../server.js";
import { chooseRecording } from "./models.js";
import { isOver, isRestarting, runStatus } from "../run_status.js";
import { alive, notify, running, session, state } from "../store.js";
import { sendCommandThere } from "../timeline/seek.js";
import { embedded } from "../address.js";
import { speedIsKnown } from "./pace.js";
import { SeedField } from "./seed.js";
import { runUntil } from "./until.js";

/** Speeds as [text, multiple of real time]; null for as fast as possible. */
const SPEEDS = [["1/20 x", 0.05], ["1/10 x", 0.1], ["1/4 x", 0.25], ["1/2 x", 0.5], ["1 x", 1], ["2 x", 2], ["5 x", 5], ["10 x", 10], ["20 x", 20], ["fastest", null]];

/** Whether the run cannot continue from here. */
function isDone() {
  return isOver.value || !session.value?.alive;
}

/** Runs or pauses; restarts a run that is over. */
function toggle() {
  if (isRestarting.value) request({ type: "run" }).catch(() => {}); // goes to the new run; a message says why it cannot be made
  else if (running.value) sendCommand({ type: "pause" });
  else if (isDone() && session.value.recorded !== null) runAgain();
  else if (isDone()) sendCommand({ type: "restart", run: true });
  else sendCommandThere({ type: "run" });
}

/** Runs a recording from its start, as it was recorded; a new run would use the model's current text. One that was stopped is opened again. */
async function runAgain() {
  const { alive: lives, recorded } = session.value;
  if (!lives) return chooseRecording(recorded, { run: true }).catch((error) => notify(error.message));
  await sendCommand({ type: "seek", time: 0 });
  return sendCommand({ type: "run" });
}

const BUTTONS = [
  { id: "back", text: "Step back by one tick", key: "ArrowLeft", what: { type: "back" }, send: sendCommandThere },
  { id: "step", text: "Step by one tick", key: "ArrowRight", what: { type: "step" }, send: sendCommandThere },
  { id: "cycle", text: "Step until the next production fires", key: "c", what: { type: "cycle" }, send: sendCommandThere },
  { id: "restart", text: "Restart with the same seed", key: "r", what: { type: "restart" }, needs: "models folder" },
  { id: "new-seed", icon: "seed", text: "Restart with a new seed", key: "Shift+r", what: { type: "restart", new_seed: true }, needs: "models folder" },
  { id: "stop", text: "Stop the model, whatever it does", key: "Mod+.", what: { type: "stop" }, needs: "models folder" },
];

const shownButtons = BUTTONS.filter(({ needs = null }) => isAvailable(needs));

/** Whether a button is disabled; its key is then disabled too. */
function isIdle(id) {
  const { alive, loading } = session.value ?? {};
  if (!session.value || runStatus.value.is === "restarted") return true;
  if (id === "run") return embedded === null ? loading && !isRestarting.value : !alive;
  if (id === "stop") return !alive && !loading;
  if (id === "back") return !alive || !state.value?.time;
  return ["step", "cycle", "until"].includes(id) && isDone();
}

/** Registers a command that changes the speed, up to a limit. */
function registeredSpeed(text, key, by, limit) {
  const isAtLimit = () => speedNumber() === limit;
  const ready = () => !isIdle("speed") && !isAtLimit();
  const why = () => (session.value && isAtLimit() ? `The speed is «${SPEEDS[limit][0]}» already.` : runStatus.value.text);
  return command({ text, key, group: "Run", work: () => setSpeed(speedNumber() + by), ready, why });
}

/** Registers a command of the run, with the id of its button. */
function registered(id, text, key, work, needs = null) {
  return command({ text, key, group: "Run", work, ready: () => !isIdle(id), why: () => (id === "back" && alive.value ? "The run is at its start." : runStatus.value.text), needs });
}

const toggling = registered("run", "Run or pause; in the past, continue from here", " ", toggle);
const byButton = new Map(BUTTONS.map(({ id, text, key, what, send = sendCommand, needs }) => [id, registered(id, text, key, () => send(what), needs)]));
const until = registered("until", "Run until …", "u", runUntil);
const faster = registeredSpeed("Faster", "+", 1, SPEEDS.length - 1);
const slower = registeredSpeed("Slower", "-", -1, 0);
commandsOf(() => SPEEDS.map(([text], n) => ({ text: `Speed: ${text}`, group: "Run", work: () => setSpeed(n), ready: () => Boolean(session.value), why: () => runStatus.value.text })));

/** Returns the maximum speed of this and later runs: the chosen one; if none was chosen, that of the run, which depends on whether it has a body. */
function reportedSpeed() {
  const { speed = null, real_time: inRealTime } = session.value ?? {};
  return inRealTime ? (state.value === null ? 1 : state.value.wanted) : speed;
}

const speed = optimistic(
  reportedSpeed,
  (factor) => ({ type: "speed", factor }),
);

function speedNumber() {
  const at = SPEEDS.findIndex(([, factor]) => factor === speed.value.value);
  return at < 0 ? SPEEDS.length - 1 : at;
}

function setSpeed(number) {
  speedIsKnown.value = true;
  speed.set(SPEEDS[number][1]);
}

export function Transport() {
  const goes = running.value && !isRestarting.value;
  const hasRun = session.value && isDone() && runStatus.value.is !== "unloadable" && !session.value.loading && !isRestarting.value;
  const text = goes ? "Pause" : hasRun ? "Run again" : "Run";
  return html`<div class="transport" role="toolbar" aria-label="Run">
    <${Button} id="run" class="primary" disabled=${isIdle("run")} title=${buttonTitle(toggling, text)} onClick=${() => run(toggling)}>
      <${Icon} name=${goes ? "pause" : "run"} />${text}
    <//>
    ${shownButtons.map(
      (button) => html`<${Button}
        key=${button.id}
        id=${button.id}
        class="bare"
        disabled=${isIdle(button.id)}
        title=${buttonTitle(byButton.get(button.id))}
        aria-label=${button.text}
        onClick=${() => run(byButton.get(button.id))}
      >
        <${Icon} name=${button.icon ?? button.id} />
      <//>${button.id === "new-seed" ? html`<${SeedField} />` : null}`,
    )}
    <${Button} id="until" class="bare" disabled=${isIdle("until")} title=${buttonTitle(until)} aria-label="Run until" onClick=${() => run(until)}><${Icon} name="until" /><//>
    <select aria-label="Speed" title="Maximum speed, as a multiple of real time (${keyText(faster.key)} and ${keyText(slower.key)})" value=${String(speedNumber())} disabled=${!session.value} onChange=${(event) => setSpeed(Number(event.currentTarget.value))}>
      ${SPEEDS.map(([text], n) => html`<option value=${String(n)}>${text}</option>`)}
    </select>
  </div>`;
}
