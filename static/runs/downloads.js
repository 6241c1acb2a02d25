// Downloads of recordings: created by the server, which may take a while; several at once.

import { html, signal } from "../vendor/preact.js";
import { useElapsed } from "../parts/elapsed.js";
import { saveFile } from "../parts/picture.js";
import { fetchFile, recordingPath } from "../server.js";
import { notify } from "../store.js";
import { nameOf, sizeText } from "./wording.js";

const FORMATS = [
  ["sqlite", "SQLite", "The recording file, unchanged"],
  ["replay.html", "HTML replay", "One file that plays its 3D scene beside its trace, without the workbench"],
  ["events.csv", "CSV of events", "Time, source, kind and data of all events"],
  ["states.csv", "CSV of states", "MuJoCo's state at the start and at the end of each tick; columns have the names of joints"],
];
/** The formats of recordings with a simulation. */
const OF_STATES = ["replay.html", "states.csv"];

/** Returns the formats in which a recording can be downloaded: [format, name, title]. */
export function formatsOf(run) {
  return run.problem ? FORMATS.slice(0, 1) : FORMATS.filter(([format]) => run.states > 0 || !OF_STATES.includes(format));
}

/** Returns the address of the file of a recording in a format. */
export const filePath = (run, format) => `${recordingPath(run.id)}/file?form=${format}`;

/** The active downloads: {key, text, since, come, all}, with the bytes received and their total, 0 while the file is being created. */
const downloads = signal([]);
const cancels = new Map();

function note(key, change) {
  downloads.value = downloads.value.map((one) => (one.key === key ? { ...one, ...change } : one));
}

/** Fetches a file of a recording and saves it on the user's computer. Errors are shown as messages. */
export async function download(run, format, title) {
  const key = `${run.id}.${format}`;
  if (cancels.has(key)) return; // it is already being downloaded
  const cancel = new AbortController();
  cancels.set(key, cancel);
  const text = `${title} of ${nameOf(run)}`;
  downloads.value = [...downloads.value, { key, text, since: Date.now(), come: 0, all: 0 }];
  try {
    const blob = await fetchFile(filePath(run, format), cancel.signal, (come, all) => note(key, { come, all }));
    saveFile(key, blob);
  } catch (error) {
    if (!cancel.signal.aborted) notify(`Not downloaded: ${text}: ${error.message}`);
  }
  cancels.delete(key);
  downloads.value = downloads.value.filter((one) => one.key !== key);
}

function Going({ key_, text, since, come, all }) {
  const elapsed = useElapsed(since);
  const far = all > 0 ? `${sizeText(come)} of ${sizeText(all)}` : `being made, ${elapsed}`;
  return html`<li>
    <progress aria-label="Downloading" value=${all > 0 ? come / all : undefined}></progress>
    <span class="text">${text}</span> <span class="number quiet">${far}</span>
    <button class="bare" aria-label=${`Cancel ${text}`} onClick=${() => cancels.get(key_)?.abort()}>Cancel</button>
  </li>`;
}

/** The active downloads, of any recording. */
export function Downloads() {
  if (downloads.value.length === 0) return null;
  return html`<ul class="going" role="status" aria-label="Downloads">${downloads.value.map((one) => html`<${Going} key=${one.key} key_=${one.key} ...${one} />`)}</ul>`;
}
