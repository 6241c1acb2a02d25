// The status of the run: its name, its text in the status line, and what panels show if they are empty. All panels use the same
// texts for the same status.

import { computed } from "./vendor/preact.js";
import { toShowOne } from "./bar/models.js";
import { alive as stated, connected, events, opening, period, restarted, session, state } from "./store.js";
import { runTimeText } from "./timeline/seek.js";
import { embedded } from "./address.js";

const AGAIN = embedded === null ? "«Run again» starts it from the beginning." : "Run its cell again to start a new run.";
const FIX = embedded === null ? "see Messages for the reason and the line. Fix it in the editor, then run it again." : "the cell shows the reason.";
const RESTARTED =
  embedded === null
    ? "The workbench was started again: open the address that it printed. What this run has recorded is among the runs there."
    : "The kernel does not answer any more: run the cell again.";
const STOP = embedded === null ? "it answers after this step. Stop ends it." : "it answers after this step, or after the cell.";

/** The states: `line` is a word or two, `text` describes the status and what to do. Both receive the result of `known`. */
const STATUSES = {
  restarted: { line: () => (embedded === null ? "stopped with the workbench" : "stopped with the kernel"), text: () => RESTARTED },
  none: { line: () => "no run", text: () => toShowOne.value },
  loading: { line: loadingLine, text: () => opening.value?.text ?? "The model is being loaded …" },
  unloadable: { line: () => "the model cannot be loaded", text: () => `This model cannot be loaded: ${FIX}` },
  ready: { line: withReason, text: ({ kind }) => (kind === "program" ? "Press Run: the program creates its agent while it runs." : "Press Run, or step.") },
  running: { line: withReason, text: () => "It is shown as soon as the run pauses." },
  busy: { line: ({ status, at }) => `${status ?? "loading"} (busy${at})`, text: ({ at }) => `The model is busy${at}; ${STOP}` },
  halted: { line: ({ signal }) => `stopped by ${signal}`, text: ({ signal }) => `The model's process was stopped by ${signal} and does not continue. Stop ends it.` },
  paused: { line: withReason, text: () => "The run is paused." },
  ended: { line: endedLine, text: () => `The run is over; you can go back on the timeline. ${AGAIN}` },
  failed: { line: withReason, text: () => `The run has failed: ${FIX}` },
  stopped: { line: stoppedLine, text: () => `The run was stopped: nothing more can be asked of it. ${AGAIN}` },
  lost: { line: ({ ending }) => `failed: ${ending}`, text: ({ ending }) => `There is no run any more: ${ending}. What happened just before that may be missing. ${AGAIN}` },
};

/** The states that end by themselves, perhaps while the page does not hear of it. */
const CHANGING = ["loading", "running", "busy"];

function loadingLine() {
  return opening.value?.slow ? "the workbench is starting …" : "loading …";
}

function withReason({ status, reason }) {
  return reason ? `${status}: ${reason}` : status;
}

/** Returns the time of the newest event [s], apart from the end of the run; null before the first, or if the page does not have it. */
export function lastEvent() {
  if (events.value.elsewhere) return null;
  const [last = null] = events.value.list.findLast(([, , kind]) => kind !== "stop") ?? [];
  return last === null ? null : last / 1e6;
}

/** Time may pass before a run ends in which nothing happens, such as that in which a memory knows what was retrieved recently. */
function endedLine(facts) {
  const last = lastEvent();
  const isQuiet = last !== null && facts.furthest - last > 2 * period.value;
  return `${withReason(facts)}${isQuiet ? `; the last event was at ${runTimeText(last)}` : ""}`;
}

/** A run that has ended by itself may be stopped too: then it can no longer answer questions. */
function stoppedLine({ status, reason }) {
  return reason === "stopped" || !reason ? "stopped" : `${withReason({ status, reason })}; stopped`;
}

/** Whether a new run is under way, while the page still shows the previous one. */
export const isRestarting = computed(() => {
  const { loading, alive, kind } = session.value ?? {};
  return kind !== undefined && Boolean(loading || (alive && !stated.value));
});

/** Returns a summary of the session and the newest state. */
function known() {
  const { alive = false, loading = false, kind, stuck, ending = "" } = session.value ?? {};
  const { status, reason = "", furthest = 0 } = state.value ?? {};
  const at = stuck?.line ? ` at line ${stuck.line}` : "";
  return { alive, loading: loading || isRestarting.value, kind, stuck: Boolean(stuck), signal: stuck?.signal ?? "", at, status, reason, furthest, ending: ending || reason || "its process has ended" };
}

function nameOf({ alive, loading, kind, stuck, signal, status, furthest, ending }) {
  if (connected.value === false && restarted.value) return "restarted";
  if (!session.value) return opening.value ? "loading" : "none";
  if (stuck && (alive || loading)) return signal ? "halted" : "busy";
  if (alive) return status === undefined ? "loading" : status === "paused" && furthest === 0 ? "ready" : status;
  if (loading && kind === undefined) return "loading";
  if (ending === "stopped" || status === "ended") return "stopped";
  return kind === undefined && !session.value.ending ? "unloadable" : "lost";
}

/**
 * The status of the run: {is, line, text}. `is` means: the workbench of the run was started again; no run is shown; it is loading; it
 * cannot be loaded, see Messages; it is ready, running, busy with something that does not end, halted by a signal, or paused; it has ended
 * by itself; the model has failed; a user has stopped it with its process; its process is lost.
 */
export const runStatus = computed(() => {
  const facts = known();
  const is = nameOf(facts);
  const line = facts.loading && is !== "busy" && is !== "halted" ? loadingLine() : STATUSES[is].line(facts);
  return { is, line: connected.value === false && CHANGING.includes(is) ? `${line} when the connection was lost` : line, text: STATUSES[is].text(facts) };
});

const isOne = (names) => computed(() => names.includes(runStatus.value.is));
/** Whether the run is over at the current moment. */
export const isOver = isOne(["ended", "failed", "stopped", "lost", "restarted"]);
/** Whether the run can answer no questions, because it does not exist yet or any more. */
export const isGone = isOne(["none", "loading", "unloadable", "stopped", "lost", "restarted"]);
/** Whether there is no agent to inspect: no run is known, or its program has not created one. */
export const isBare = computed(() => state.value === null || (session.value?.kind === "program" && !session.value.world && Object.keys(state.value.parts).length === 0));

/** Returns why a panel is empty; `none` is its text for a model without such contents. */
export function nothing(none) {
  if (!isBare.value) return none;
  const { is, text } = runStatus.value;
  if (is === "ended") return `The program is over, and has made no model. ${AGAIN}`;
  return is === "ready" ? `There is nothing to show yet. ${text}` : is === "running" ? "There is no model yet." : text;
}

/** Returns the text for an empty list of events; `never` is the text once the run has ended. */
export function nothingYet(never = "Nothing has happened in this run.") {
  const { is, text } = runStatus.value;
  if (isBare.value && is !== "ready") return nothing("");
  return isOver.value ? never : `Nothing has happened yet.${is === "ready" ? ` ${text}` : ""}`;
}

/** Returns what happens to the chosen production; `now` if it was chosen last. */
export function chosenText(now = true) {
  return now && isOver.value ? "was chosen as the run ended" : "is about to fire";
}
