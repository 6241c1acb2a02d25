// Chooses the model or recording to show: opens its session or starts one, and puts the choice into the page's address.

import { computed, effect, html, signal, useLayoutEffect } from "../vendor/preact.js";
import { addressed, addressedTime, alone, goToAddress, leaveMoment } from "../address.js";
import { commandsOf } from "../commands.js";
import { exactTime, TIMES, timeText } from "../parts/units.js";
import { call, connect, request, sessionOf, showModel, showRecording, sinceNow } from "../server.js";
import { parts, withPresentNames } from "../runs/list.js";
import { withTrust } from "../runs/trust.js";
import { alive, connected, isShared, notify, running, session, shownRecording } from "../store.js";
import { furthest, isBeyond, present, runTimeText, travel } from "../timeline/seek.js";
import { followWindows, passOn } from "../windows.js";

/** The model files of the folder that can be opened: {path, title, kind}. */
export const models = signal([]);
/** Those that cannot be opened because of their names: {path, title, problem}, with what a path must be. */
const unusable = signal([]);
/** Returns the name of a model's file, with its folder if another folder has a file of that name. */
function shortName(path) {
  const nameOf = (one) => one.split("/").at(-1);
  return models.value.some((one) => one.path !== path && nameOf(one.path) === nameOf(path)) ? path : nameOf(path);
}

/** The path of the folder; empty before it is known. */
export const folder = signal("");
/** Whether the manual is there. */
export const hasManual = signal(false);
/** How to get the manual; null if it is there, or before this is known. */
export const noManual = signal(null);
/** The model that is shown. */
export const model = signal(null);

const NO_MODELS = "There is no model in the folder yet: make one in the tab Editor, or put a Python file there.";
/** What there is to do while no model is shown. */
export const toShowOne = computed(() => (models.value.length > 0 ? "No model is shown: choose one above." : folder.value ? NO_MODELS : "No model is shown."));

const FIRST = ["aperture_passage.py", "doorway.py"];

let asked = 0;

/** Reads the list of models again; the latest request counts. */
export async function listModels() {
  asked += 1;
  const mine = asked;
  const listing = await call("GET", "/api/models");
  if (mine !== asked) return;
  folder.value = listing.folder;
  models.value = listing.models.filter(({ problem }) => !problem);
  unusable.value = listing.models.filter(({ problem }) => problem);
  hasManual.value = listing.manual;
  noManual.value = listing.no_manual;
}

/** Shows a model. */
export async function choose(path) {
  note(path);
  try {
    if (await showModel(path)) passOn({ model: path, recorded: null });
  } catch (error) {
    notify(error.message);
  }
}

/** Shows a recording, which has its own address, so that the browser's «back» leads to what was shown before. Returns whether it is shown:
 * null if the user declines, false if the user has chosen something else meanwhile. With `run` it goes on at once; `at` as in `showRecording`. */
export async function chooseRecording(id, { run = false, at = null } = {}) {
  const left = session.peek();
  const isShown = await withTrust(id, "Opening it", (trust) => showRecording(id, { trust, run, at }));
  if (!isShown) return isShown;
  if (left && left.recorded === null) before.value = { model: left.model, id: left.id };
  goToAddress("run", id);
  passOn({ recorded: id });
  return true;
}

/** Returns the recording that has the moment [s] of a run to which a link leads: if the run was changed before that moment since the link
 * was copied, the first branch that was kept then. */
async function holderOf(id, time) {
  const copied = addressed("copied");
  if (copied === null) return id;
  const recordings = [];
  for await (const part of parts()) recordings.push(...part.recordings);
  const since = withPresentNames(recordings).filter((run) => run.copied?.[0] === id && run.kept >= Number(copied) && run.copied[1] < time);
  return since.toSorted((one, other) => one.kept - other.kept)[0]?.id ?? id;
}

/** Shows the open session of a model that writes a recording, where it is, if the model's address leads to that session. Returns whether it does. */
export async function chooseLive(id) {
  const wanted = sinceNow();
  const { sessions } = await call("GET", "/api/sessions");
  const live = sessions.find((one) => one.recording === id && one.alive && one === sessionOf(one.model, sessions));
  if (live && wanted()) await choose(live.model);
  return live !== undefined;
}

/** Shows a moment [s] of a recorded run, as a link asks for it: the run itself if it is still open, or else its recording. Returns whether it
 * is shown, as `chooseRecording`. */
async function chooseMoment(run, time) {
  const isWanted = sinceNow();
  const id = await holderOf(run, time);
  if (!isWanted()) return false;
  const isShown = (await chooseLive(id)) || (await chooseRecording(id));
  if (!isShown) return isShown;
  leaveMoment();
  const wanted = sinceNow();
  const end = effect(() => {
    if (!alive.value || shownRecording.value !== id) return;
    queueMicrotask(() => {
      end();
      if (!wanted()) return;
      if (exactTime(present.peek()) === exactTime(time)) return;
      if (isBeyond(time)) return notify(`The link leads to ${timeText(time)}; this run has only reached ${runTimeText(furthest.peek())}.`);
      const why = running.peek() ? "It goes on now." : isShared.peek() ? "Another page shows it, too." : null;
      if (why) notify(`The link leads to ${runTimeText(time)} of this run. ${why}`, "info", { text: "Go there", work: () => travel(time) });
      else travel(time);
    });
  });
  return true;
}

/** Shows the run that the address names, at its moment, if it has one. Returns whether it is shown, as `chooseRecording`. */
async function chooseAddressed(id) {
  const time = addressedTime();
  if (time !== null) return chooseMoment(id, time);
  const text = addressed("t");
  const isShown = await chooseRecording(id);
  if (text !== null && isShown) {
    notify(`The link's time must be a time, such as ${TIMES} (got ${text}).`);
    leaveMoment();
  }
  return isShown;
}

/** What was shown before a recording, for returning to it; null for nothing. */
export const before = signal(null);

/** Shows an open session; a session of a recording has the recording's address. */
export function showSession({ model: path, recorded }) {
  if (recorded === null) return choose(path);
  return chooseRecording(recorded).catch((error) => notify(error.message));
}

/** Returns the open sessions other than one, of each model or recording the newest, which `showSession` shows. */
export async function otherSessions(id) {
  const { sessions } = await call("GET", "/api/sessions");
  const newest = new Map(sessions.map((one) => [one.recorded ?? `model ${one.model}`, one]));
  return [...newest.values()].filter((one) => one.id !== id);
}

followWindows(showSession);

/** Runs a model from its start with the current text of its file; throws an Error with the reason if it fails. */
export async function runModel(path) {
  if (session.value?.model === path && session.value.recorded === null && connected.value) {
    await request({ type: "restart", run: true });
    return;
  }
  note(path);
  if (await showModel(path, { run: true })) passOn({ model: path, recorded: null });
}

/** Remembers which model is shown, also for the next time the page is loaded. */
export function note(path) {
  model.value = path;
  sessionStorage.setItem("model", path);
  goToAddress("model", path);
}

/** Shows what the address names, after «back» or «forward». */
function follow() {
  const [run, path] = [addressed("run"), addressed("model")];
  if (run !== null) chooseAddressed(run).catch((error) => notify(error.message));
  else if (path !== null) choose(path);
}

addEventListener("popstate", follow);

/** A recording that is changed becomes another one: the address becomes that of the branch. One that is started as a new run is no longer a
 * recording: the address becomes the model's. A window of its own has the address of what its page shows. */
let shown = { id: null, recorded: null };
effect(() => {
  const { id = null, recorded = null, model: path } = session.value ?? {};
  const isChanged = id === shown.id && shown.recorded !== null && recorded !== shown.recorded;
  const isOther = id !== null && (isChanged || (alone !== null && id !== shown.id));
  shown = { id, recorded };
  if (isOther && recorded === null) note(path);
  else if (isOther) goToAddress("run", recorded);
});

commandsOf(
  () => [
    ...models.value.map(({ path, title }) => ({ text: `Model: ${path}`, group: title, work: () => choose(path) })),
    ...unusable.value.map(({ path, title, problem }) => ({ text: `Model: ${path}`, group: title, work: () => {}, ready: () => false, why: () => `The path of a model file: ${problem}.` })),
  ],
  { needs: "models folder" },
);

/** Shows what the address names, or the model shown last, when the page is opened; if the workbench does not answer, as soon as it does. */
export async function begin() {
  connect();
  try {
    await listModels();
  } catch (error) {
    notify(error.message);
    return;
  }
  if (model.value !== null) return; // the user has already chosen one
  const run = addressed("run");
  let problem = null;
  if (run !== null) {
    try {
      if ((await chooseAddressed(run)) !== null) return;
    } catch (error) {
      problem = `The recording «${run}» cannot be opened: ${error.message}`;
    }
  }
  const paths = models.value.map(({ path }) => path);
  if (paths.length === 0) {
    notify(NO_MODELS, "info");
    if (problem !== null) notify(problem);
    return;
  }
  const asked = addressed("model");
  if (asked !== null && !paths.includes(asked)) problem ??= `There is no model «${asked}» in this folder; this is another one.`;
  const wanted = [asked, sessionStorage.getItem("model"), ...FIRST];
  if (run === null && addressed("t") !== null) {
    problem ??= "Only the address of a recorded run can have a time t; the model is shown as it is.";
    leaveMoment();
  }
  await choose(wanted.find((path) => paths.includes(path)) ?? paths[0]);
  if (problem !== null) notify(problem); // only now, because messages are cleared with the session shown before
}

/** The end of a choice of files: those that cannot be opened, each with what its path must be. */
export function UnusableModels() {
  if (unusable.value.length === 0) return null;
  return html`<optgroup label="Files with invalid names">${unusable.value.map(({ path, problem }) => html`<option key=${path} disabled title=${path}>${path}: ${problem}</option>`)}</optgroup>`;
}

export function ModelChoice() {
  useLayoutEffect(() => void begin(), []);
  const recorded = session.value?.recorded ?? null;
  const shown = recorded !== null ? "" : session.value?.model ?? model.value ?? "";
  const gone = shown && models.value.length > 0 && !models.value.some(({ path }) => path === shown);
  const folders = Map.groupBy(models.value, ({ path }) => path.split("/").slice(0, -1).join("/"));
  const option = ({ path, title }) => html`<option key=${path} value=${path} title=${title}>${shortName(path)}</option>`;
  return html`<select
    class="model"
    aria-label="Model"
    title=${recorded !== null ? `recording of ${session.value.model}` : models.value.find(({ path }) => path === shown)?.title ?? ""}
    value=${shown}
    onChange=${(event) => choose(event.currentTarget.value)}
  >
    ${models.value.length === 0 ? html`<option value="">no models</option>` : null}
    ${recorded !== null ? html`<option value="">a recording</option>` : null}
    ${gone ? html`<option value=${shown}>${shown} (not in the folder)</option>` : null}
    ${[...folders].map(([folder, list]) => (folder ? html`<optgroup key=${folder} label=${folder}>${list.map(option)}</optgroup>` : list.map(option)))}
    <${UnusableModels} />
  </select>`;
}
