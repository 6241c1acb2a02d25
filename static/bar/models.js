// Which model is shown: choosing one shows the session with it, or begins one.

import { html, signal, useLayoutEffect } from "../vendor/preact.js";
import { call, say, showModel } from "../server.js";
import { complain, connected, session } from "../store.js";

/** The model files of the folder: {path, title, kind}. */
export const models = signal([]);
/** Where the folder is. */
export const folder = signal("");
/** The model that is shown. */
export const model = signal(null);

const FIRST = ["aperture_passage.py", "doorway.py"];

let asked = 0;

/** Reads anew which models there are; what is asked last holds. */
export async function listModels() {
  asked += 1;
  const mine = asked;
  const told = await call("GET", "/api/models");
  if (mine !== asked) return;
  folder.value = told.folder;
  models.value = told.models;
}

/** Shows a model. */
export async function choose(path) {
  note(path);
  try {
    await showModel(path);
  } catch (error) {
    complain(error.message);
  }
}

/** Runs a model from its start, as its file is now; throws an Error that says why not. */
export async function runModel(path) {
  if (session.value?.model === path && connected.value) {
    await say({ type: "restart", run: true });
    return;
  }
  note(path);
  await showModel(path, { run: true });
}

/** Remembers which model is shown, also for when the page is loaded again. */
export function note(path) {
  model.value = path;
  sessionStorage.setItem("model", path);
  history.replaceState(null, "", `?model=${encodeURIComponent(path)}`);
}

async function begin() {
  try {
    await listModels();
  } catch (error) {
    complain(error.message);
    return;
  }
  const paths = models.value.map(({ path }) => path);
  if (paths.length === 0) {
    complain("There is no model in the folder yet: make one in the tab Editor, or put a Python file there.", "info");
    return;
  }
  if (model.value !== null) return; // the user has chosen one already
  const wanted = [new URLSearchParams(location.search).get("model"), sessionStorage.getItem("model"), ...FIRST];
  await choose(wanted.find((path) => paths.includes(path)) ?? paths[0]);
}

export function ModelChoice() {
  useLayoutEffect(() => void begin(), []);
  const shown = session.value?.model ?? model.value ?? "";
  const gone = shown && models.value.length > 0 && !models.value.some(({ path }) => path === shown);
  const folders = Map.groupBy(models.value, ({ path }) => path.split("/").slice(0, -1).join("/"));
  const option = ({ path, title }) => html`<option key=${path} value=${path} title=${title}>${path.split("/").at(-1)}</option>`;
  return html`<select
    class="model"
    aria-label="Model"
    title=${models.value.find(({ path }) => path === shown)?.title ?? ""}
    value=${shown}
    onChange=${(event) => choose(event.currentTarget.value)}
  >
    ${models.value.length === 0 ? html`<option value="">no models</option>` : null}
    ${gone ? html`<option value=${shown}>${shown} (not in the folder)</option>` : null}
    ${[...folders].map(([folder, list]) => (folder ? html`<optgroup key=${folder} label=${folder}>${list.map(option)}</optgroup>` : list.map(option)))}
  </select>`;
}
