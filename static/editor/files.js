// New, duplicate, rename, delete: asks for a name, and shows what is wrong with it.

import { before, choose, listModels, models, note } from "../bar/models.js";
import { asked, confirmed } from "../parts/dialog.js";
import { offerRestore } from "../parts/restore.js";
import { call, sinceNow } from "../server.js";
import { notify, session } from "../store.js";
import { focusText } from "./code.js";
import { close, open, renamed, shown } from "./documents.js";
import { TEMPLATES } from "./templates.js";

/** Creates a new model file, and shows its text here and its run in the page, as choosing a model does. */
export async function makeNew() {
  const last = shown.peek();
  const wanted = sinceNow();
  const choices = TEMPLATES.map(({ value, text }) => ({ value, text }));
  const file = await named("New model", "Name of the file", "my_model.py", "Create", { choices }, (path, choice) => {
    const { source } = TEMPLATES.find(({ value }) => value === choice);
    return call("PUT", "/api/model", { path, text: source, version: null });
  });
  if (showNew(file, last) && wanted()) choose(file.path);
}

/** Opens a new file, unless the user has chosen another one since; returns whether it is opened. */
function showNew(file, last) {
  const isWanted = file !== null && shown.peek() === last;
  if (isWanted) open(file.path).then(() => requestAnimationFrame(focusText)); // once it is visible
  return isWanted;
}

/** Copies the saved version of a model file. */
export async function duplicate(path) {
  const last = shown.peek();
  const to = path.replace(/\.py$/, "_copy.py");
  const file = await named(`Duplicate ${path}`, "Name of the copy", to, "Duplicate", {}, (name) => call("POST", "/api/model/duplicate", { path, to: name }));
  showNew(file, last);
}

/** Renames a model file; its run continues. */
export async function rename(path) {
  const file = await named(`Rename ${path}`, "New name", path, "Rename", {}, (to) => (to === path ? null : call("POST", "/api/model/rename", { path, to })));
  if (!file) return;
  renamed(path, file);
  if (before.value?.model === path) before.value = { ...before.value, model: file.path };
  const { model, recorded } = session.value ?? {};
  if (recorded === null && [path, file.path].includes(model)) note(file.path);
}

/** Moves a model file to the trash folder, after asking. */
export async function remove(path, unsaved) {
  const text = `It goes to the trash folder .workbench/trash.${unsaved ? " Its unsaved changes are lost." : ""}`;
  if (!(await confirmed(`Delete ${path}?`, text, "Delete"))) return;
  try {
    const { trash } = await call("POST", "/api/model/delete", { path });
    close(path);
    offerRestore(`The model «${path}» is`, [trash], listModels);
    await listModels();
  } catch (error) {
    notify(error.message);
  }
}

/** Asks for a name until it is valid or the user cancels; returns the file. */
async function named(title, label, name, action, more, work) {
  let problem = null;
  for (;;) {
    const given = await asked(title, label, name, action, { ...more, problem });
    const { text, choice } = typeof given === "string" ? { text: given } : given ?? {};
    if (given === null) return null;
    if (!text) {
      problem = "enter a name";
      continue;
    }
    const taken = name;
    name = text.endsWith(".py") ? text : `${text}.py`;
    if (models.value.some(({ path }) => path === name) && !(title.startsWith("Rename") && name === taken)) {
      problem = `there is a '${name}' already`;
      continue;
    }
    try {
      const file = await work(name, choice);
      await listModels().catch((error) => notify(error.message));
      return file;
    } catch (error) {
      problem = error.message;
    }
  }
}
