// What state the run is in, as one idea: its name, what the line below says of it, and what there is to do where a panel has nothing to
// show. All panels say the same of the same state.

import { computed } from "./vendor/preact.js";
import { opening, session, state } from "./store.js";

const AGAIN = "«Run again» begins it anew.";
const MEND = "Messages says why, with the line. Mend it in the Editor, and run it again.";

/** The states: `line` says each in a word or two, `text` what is so and what to do. Both are told what `known` returns. */
const STANDINGS = {
  none: { line: () => "no run", text: () => "No model is shown: choose one above." },
  loading: { line: loadingLine, text: () => opening.value?.text ?? "The model is being loaded …" },
  unloadable: { line: () => "the model cannot be loaded", text: () => `This model cannot be loaded: ${MEND}` },
  ready: { line: asTold, text: ({ kind }) => (kind === "program" ? "Press Run: the program makes its model as it goes." : "Press Run, or step.") },
  running: { line: asTold, text: () => "It is told as soon as the run pauses." },
  busy: { line: ({ status, at }) => `${status ?? "loading"} (busy${at})`, text: ({ at }) => `The model is busy${at}; it answers after this step. Stop ends it.` },
  halted: { line: ({ signal }) => `stopped by ${signal}`, text: ({ signal }) => `The model's process was stopped by ${signal} and stands still. Stop ends it.` },
  paused: { line: asTold, text: () => "The run is paused." },
  ended: { line: asTold, text: () => `The run is over. Go back on the timeline; ${AGAIN}` },
  failed: { line: asTold, text: () => `The run has failed: ${MEND}` },
  stopped: { line: stoppedLine, text: () => `The run was stopped: nothing more can be asked of it. ${AGAIN}` },
  lost: { line: ({ ending }) => `failed: ${ending}`, text: ({ ending }) => `There is no run any more: ${ending}. What happened just before that may not be told. ${AGAIN}` },
};

function loadingLine() {
  return opening.value?.slow ? "the workbench is starting …" : "loading …";
}

function asTold({ status, reason }) {
  return reason ? `${status}: ${reason}` : status;
}

/** A run that was over by itself may be stopped, too: then nothing more can be asked of it. */
function stoppedLine({ status, reason }) {
  return reason === "stopped" || !reason ? "stopped" : `${asTold({ status, reason })}; stopped`;
}

/** Sums up what the session and the newest state tell. */
function known() {
  const { alive = false, loading = false, kind, stuck, ending = "" } = session.value ?? {};
  const { status, reason = "", furthest = 0 } = state.value ?? {};
  const at = stuck?.line ? ` at line ${stuck.line}` : "";
  return { alive, loading, kind, stuck: Boolean(stuck), signal: stuck?.signal ?? "", at, status, reason, furthest, ending: ending || reason || "its process has ended" };
}

function nameOf({ alive, loading, kind, stuck, signal, status, furthest, ending }) {
  if (!session.value) return opening.value ? "loading" : "none";
  if (stuck && (alive || loading)) return signal ? "halted" : "busy";
  if (alive) return status === undefined ? "loading" : status === "paused" && furthest === 0 ? "ready" : status;
  if (loading && kind === undefined) return "loading";
  if (ending === "stopped" || status === "ended") return "stopped";
  return kind === undefined && !session.value.ending ? "unloadable" : "lost";
}

/**
 * How the run stands: {is, line, text}. `is` tells: none is shown; it is loading; it is unloadable, for what Messages tell; it is ready,
 * running, busy with what does not end, halted by a signal, or paused; it has ended by itself; the model has failed; a user has stopped it with its
 * process; its process is lost.
 */
export const standing = computed(() => {
  const told = known();
  const is = nameOf(told);
  return { is, line: told.loading && is !== "busy" && is !== "halted" ? loadingLine() : STANDINGS[is].line(told), text: STANDINGS[is].text(told) };
});

const isOne = (names) => computed(() => names.includes(standing.value.is));
/** Whether the run is over, as it stands now. */
export const isOver = isOne(["ended", "failed", "stopped", "lost"]);
/** Whether nothing can be asked of the run, for it is not there, or not any more. */
export const isGone = isOne(["none", "loading", "unloadable", "stopped", "lost"]);
/** Whether there is no mind to look into: no run is known, or its program has not made one. */
export const isBare = computed(() => state.value === null || (session.value?.kind === "program" && !session.value.world && Object.keys(state.value.parts).length === 0));

/** Says why a panel has nothing to show; `none` is what it says of a model that has nothing of the kind. */
export function nothing(none) {
  if (!isBare.value) return none;
  const { is, text } = standing.value;
  if (is === "ended") return `The program is over, and has made no model. ${AGAIN}`;
  return is === "ready" ? `There is no model yet. ${text}` : is === "running" ? "There is no model yet." : text;
}

/** Says why there is nothing of what happens: not yet, or, in a run that is over, `never`. */
export function nothingYet(never = "Nothing has happened in this run.") {
  const { is, text } = standing.value;
  if (isBare.value && is !== "ready") return nothing("");
  return isOver.value ? never : `Nothing has happened yet.${is === "ready" ? ` ${text}` : ""}`;
}

/** Says of the production that was chosen what comes of it; `now` where it was chosen last. */
export function chosenText(now = true) {
  return now && isOver.value ? "was chosen as the run ended" : "is about to fire";
}
