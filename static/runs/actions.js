// Actions on recordings: open, add, run again, delete; with their progress and results.

import { chooseRecording } from "../bar/models.js";
import { signal } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { confirmed } from "../parts/dialog.js";
import { offerRestore } from "../parts/restore.js";
import { call, recordingPath, sendFile, sinceNow } from "../server.js";
import { me, notify, session } from "../store.js";
import { forgetRun, listRuns, runs } from "./list.js";
import { chosen } from "./table.js";
import { withTrust } from "./trust.js";
import { nameOf, sizeText, whenText } from "./wording.js";

/** The results of replays by id: {since, share} while one is running, then {verdict, text}, with the number of events that the list had then. */
export const replays = signal({});
/** The current slow action; null for none: {text, done?, of?}. */
export const busy = signal(null);

const LOOK = 300; // the interval between two requests for the progress of a replay [ms]
const cancels = new Map();

/** Shows a recording, in a session that replays it; closes the sessions of others that nobody views any more. `at` as in `showRecording`. */
export async function openRun(run, at = null) {
  if (busy.value || run.problem) return;
  busy.value = { text: "Opening …" };
  const wanted = sinceNow();
  try {
    await leaveOthers(run.id);
    if (wanted()) await chooseRecording(run.id, { at });
  } catch (error) {
    notify(`${run.model} of ${whenText(run.made)} cannot be opened: ${error.message}`);
  }
  busy.value = null;
}

/** Closes the sessions of other recordings that nobody views any more and that do not run: they can be opened again. */
async function leaveOthers(wanted) {
  const { sessions } = await call("GET", "/api/sessions");
  const isLeft = ({ recorded, status, watching }) => ![null, wanted].includes(recorded) && status !== "running" && watching.length === 0;
  const left = sessions.filter((one) => isLeft(one) && one.id !== session.value?.id);
  for (const { id } of left) {
    await call("POST", `/api/sessions/${id}/close`, {}).catch(() => null); // another page may have closed it
  }
}

const LARGEST = 2e9; // the largest file that the server takes [bytes]

/** Adds recording files to the recordings, and chooses them in the list; a single one is also opened. */
export async function addFiles(files) {
  if (busy.value || files.length === 0) return;
  const added = [];
  for (const [n, file] of files.entries()) {
    busy.value = { text: "Adding", done: n, of: files.length };
    try {
      if (file.size > LARGEST) throw new Error(`it is larger than ${sizeText(LARGEST)}`);
      const name = file.name.slice(-100); // the end of a name differs most
      added.push(await sendFile(`/api/recordings/import?name=${encodeURIComponent(name)}`, file));
    } catch (error) {
      notify(`${file.name} is not added to the recordings: ${error.message}`);
    }
  }
  busy.value = null;
  if (added.length > 0) chosen.value = new Set(added.map(({ id }) => id));
  await listRuns();
  if (files.length === 1 && added.length === 1) await openRun(added[0]);
}

/** Asks for recording files, and adds them. */
export function chooseFiles() {
  const field = Object.assign(document.createElement("input"), { type: "file", multiple: true, accept: ".sqlite" });
  field.onchange = () => addFiles([...field.files]);
  field.click();
}

function note(id, replay) {
  replays.value = { ...replays.value, [id]: replay };
}

/** Runs a recording again in a separate process, unless it is running; the result is stored in `replays`. */
export async function replayRun(run) {
  if (cancels.has(run.id)) return;
  const cancel = new AbortController();
  cancels.set(run.id, cancel);
  const path = `${recordingPath(run.id)}/replay`;
  note(run.id, { since: Date.now(), share: 0 });
  const look = setInterval(async () => {
    const progress = await call("GET", path, undefined, cancel.signal).catch(() => null);
    const { since } = replays.value[run.id];
    if (since && progress?.share) note(run.id, { since, share: progress.share });
  }, LOOK);
  try {
    const verdict = await withTrust(run.id, "Replaying it", (trust) => call("POST", path, { trust }, cancel.signal));
    if (verdict) await listRuns();
    note(run.id, verdict ? { ...verdict, events: runs.value?.find(({ id }) => id === run.id)?.events } : { verdict: null, text: "cancelled" });
  } catch (error) {
    note(run.id, { verdict: null, text: cancel.signal.aborted ? "cancelled" : error.message });
  }
  clearInterval(look);
  cancels.delete(run.id);
}

export function cancelReplay(id) {
  cancels.get(id)?.abort();
}

/** Returns that the branches of recordings which are deleted stay; an empty text if they have none. */
function branchesText(list) {
  const ids = new Set(list.map(({ id }) => id));
  const { length } = (runs.peek() ?? []).filter(({ id, origin }) => ids.has(origin) && !ids.has(id));
  if (length === 0) return "";
  return ` ${list.length === 1 ? "Its" : "Their"} ${length === 1 ? "branch stays" : `${length} branches stay`}.`;
}

/** Returns that other pages show recordings which are deleted; an empty text if none does. Their sessions stay open. */
async function pagesText(list) {
  const ids = new Set(list.map(({ id }) => id));
  const { sessions } = await call("GET", "/api/sessions").catch(() => ({ sessions: [] }));
  const shown = sessions.filter(({ recorded, recording }) => ids.has(recorded) || ids.has(recording));
  const pages = new Set(shown.flatMap(({ watching }) => watching).filter((name) => name !== me.peek())).size;
  if (pages === 0) return "";
  const [who, verbs] = pages === 1 ? ["Another page", ["shows", "goes"]] : [`${pages} other pages`, ["show", "go"]];
  return ` ${who} ${verbs[0]} ${list.length === 1 ? "it" : "some of them"}, and ${verbs[1]} on showing ${list.length === 1 ? "it" : "them"}.`;
}

/** Deletes recordings, after asking; except those that a run is still writing. */
export async function deleteRuns(all) {
  const list = all.filter((run) => !run.session);
  const open = all.filter((run) => run.session);
  if (open.length > 0) {
    const names = open.map(nameOf).join("; ");
    notify(`Not deleted: an open run still writes ${names}. Show and restart that run, then delete it.`);
  }
  if (list.length === 0) return;
  const one = list.length === 1 ? `the recording «${nameOf(list[0])}»` : counted(list.length, "recording");
  const where = `${list.length === 1 ? "It goes" : "They go"} to the trash folder .workbench/trash.${branchesText(list)}${await pagesText(list)}`;
  if (!(await confirmed(`Delete ${one}?`, where, "Delete"))) return;
  const refused = [];
  const deleted = [];
  for (const [n, run] of list.entries()) {
    busy.value = { text: "Deleting", done: n, of: list.length };
    try {
      const { trash } = await call("POST", `${recordingPath(run.id)}/delete`, {});
      forgetRun(run.id);
      deleted.push({ run, trash });
    } catch (error) {
      if (error.status === 404) forgetRun(run.id);
      else refused.push(`${nameOf(run)}: ${error.message}`);
    }
  }
  busy.value = null;
  const done = new Set(list.map(({ id }) => id));
  chosen.value = new Set([...chosen.value].filter((id) => !done.has(id))); // others may have been chosen meanwhile
  if (refused.length > 0) notify(`${refused.length} of ${list.length} not deleted. ${refused[0]}`);
  if (deleted.length > 0) {
    const what = deleted.length === 1 ? `The recording «${nameOf(deleted[0].run)}» is` : `${counted(deleted.length, "recording")} are`;
    offerRestore(what, deleted.map(({ trash }) => trash), listRuns);
  }
  await listRuns();
}
