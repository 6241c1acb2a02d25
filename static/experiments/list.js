// The server's experiments, read again each second while one runs; which one is shown; and what can be done with them.

import { confirmed } from "../parts/dialog.js";
import { offerRestore } from "../parts/restore.js";
import { remembered } from "../local_storage.js";
import { openTab } from "../open_tab.js";
import { withTrust } from "../runs/trust.js";
import { call, isLeft, sinceNow } from "../server.js";
import { chooseRecording } from "../bar/models.js";
import { notify, session } from "../store.js";
import { effect, signal, untracked } from "../vendor/preact.js";
import { experimentText } from "./wording.js";

const WHILE_RUNNING = 1000; // the interval between two requests for the list [ms]
const OTHERWISE = 5000;

/** The summaries of the newest experiments, the newest first; null before they are known. */
export const experiments = signal(null);
/** The number of all experiments, of which the list has the newest. */
export const total = signal(0);
/** Why they cannot be listed; null if they can. */
export const problem = signal(null);
/** The id of the experiment that is shown, "new" for the form of a new one, "" for the list. */
export const shown = remembered("experiment shown", "");
/** The part of the experiment that is shown: "figure", "trials", "about" or "report". */
export const part = signal("figure");
/** The values that the listed trials must have: {column: value}. */
export const where = signal({});
/** The trial that was opened last: {id, number, recording}, of which experiment, and the recording of it. */
const opened = remembered("trial opened", {});
/** Returns whether a recording of a trial is shown. */
export const isOpen = (id, number) => opened.value.id === id && opened.value.number === number && opened.value.recording === session.value?.recorded;
/** What the page waits for, by experiment: {id: {text, cancel}}; `cancel` is null for what cannot be cancelled. */
const waits = signal({});

/** Returns what the page waits for of an experiment: {text, cancel}; null for nothing. */
export const waitOf = (id) => waits.value[id] ?? null;

/** Whether something happens to an experiment that ends by itself. */
const isChanging = (one) => isRunning(one) || one.state === "elsewhere" || one.work.length > 0;
/** Whether an experiment runs. */
export const isRunning = ({ state }) => state === "running" || state === "stopping";

export const canStop = ({ state }) => state === "running";
export const canResume = ({ state, done, total }) => (state === "stopped" || state === "failed") && (total === null || done < total);
export const canMakeReport = (one) => one.done > 0 && !isRunning(one);

let asked = 0;

export async function listExperiments() {
  asked += 1;
  const mine = asked;
  try {
    const answer = await call("GET", "/api/experiments");
    if (mine !== asked) return;
    experiments.value = answer.experiments;
    total.value = answer.total;
    problem.value = null;
  } catch (error) {
    if (mine === asked) problem.value = error.message;
  }
}

/** Keeps the list up to date while it is shown; returns the function that stops this. */
export function followExperiments() {
  let over = false;
  let timer = 0;
  async function again() {
    await listExperiments();
    clearTimeout(timer); // another request may have ended meanwhile
    if (!over) timer = setTimeout(again, experiments.value?.some(isChanging) ? WHILE_RUNNING : OTHERWISE);
  }
  const stop = effect(() => {
    shown.value; // another one is shown: its newest state
    clearTimeout(timer);
    untracked(() => void again());
  });
  return () => {
    over = true;
    clearTimeout(timer);
    stop();
  };
}

/** Shows an experiment, optionally only those trials that have some values. */
export function showExperiment(id, values = null) {
  where.value = values ?? {};
  part.value = values === null ? "figure" : "trials";
  shown.value = id;
}

/** Does something with an experiment that takes a while, with a text that says so; shows an error as a message. Returns whether it was done:
 * `work` returns null if the user has declined. */
async function doing(id, text, work, cancel = null) {
  if (waitOf(id)) return false;
  waits.value = { ...waits.value, [id]: { text, cancel } };
  try {
    return (await work()) !== null;
  } catch (error) {
    if (!isLeft(error) && !cancel?.signal.aborted) notify(error.message);
    return false;
  } finally {
    waits.value = { ...waits.value, [id]: null };
    await listExperiments();
  }
}

/** Returns the address of an experiment on the server. */
export const pathOf = (id) => `/api/experiments/${encodeURIComponent(id)}`;

/** Starts an experiment and shows it, unless the user has left the form meanwhile; throws an Error with the reason if it cannot be run. */
export async function startExperiment(wanted) {
  const form = shown.peek();
  const { id } = await call("POST", "/api/experiments", wanted);
  await listExperiments();
  if (shown.peek() === form) showExperiment(id);
}

export function stopExperiment({ id }) {
  return doing(id, "Stopping …", () => call("POST", `${pathOf(id)}/stop`, {}));
}

export function resumeExperiment({ id }) {
  return doing(id, "Starting …", () => withTrust(id, "Continuing it", (trust) => call("POST", `${pathOf(id)}/resume`, { trust }), "experiments"));
}

/** Makes the report, and shows it; if the user looks at something else meanwhile, says that it is made. */
export async function makeReport(experiment) {
  const { id } = experiment;
  const cancel = new AbortController();
  const make = () => withTrust(id, "Its report", (trust) => call("POST", `${pathOf(id)}/report`, { trust }, cancel.signal), "experiments");
  if (!(await doing(id, "Making the report …", make, cancel))) return;
  const show = () => {
    openTab.value = "experiments";
    shown.value = id;
    part.value = "report";
  };
  if (shown.value === id) part.value = "report";
  else notify(`The report of ${experimentText(experiment)} is made.`, "info", { text: "Open it", work: show });
}

/** Runs a trial again, records it, and shows the recording, unless the user has chosen something else meanwhile. */
export function openTrial(id, number) {
  const cancel = new AbortController();
  const wanted = sinceNow();
  const record = (trust) => call("POST", `${pathOf(id)}/trial`, { number, trust }, cancel.signal);
  return doing(
    id,
    `Running trial ${number} again …`,
    async () => {
      const made = await withTrust(id, "Opening a trial", record, "experiments");
      if (made === null) return null;
      opened.value = { id, number, recording: made.recording };
      if (wanted()) await chooseRecording(made.recording);
      else notify(`Trial ${number} was run again and recorded as ${made.recording}: it is among the runs.`, "info");
      return made;
    },
    cancel,
  );
}

/** Deletes an experiment, after asking. */
export async function deleteExperiment({ id, name, done }) {
  const text = `Its ${done.toLocaleString("en")} finished trials go to the trash folder .workbench/trash.`;
  if (!(await confirmed(`Delete the experiment ${name}?`, text, "Delete"))) return;
  const remove = async () => {
    const { trash } = await call("POST", `${pathOf(id)}/delete`, {});
    offerRestore(`The experiment ${name} is`, [trash], listExperiments);
  };
  if ((await doing(id, "Deleting …", remove)) && shown.value === id) shown.value = "";
}
