// The name, the note and the tags of a recording, which users give.

import { dialog } from "../parts/dialog.js";
import { Problem } from "../parts/problem.js";
import { call, recordingPath } from "../server.js";
import { notify } from "../store.js";
import { html, signal } from "../vendor/preact.js";
import { listRuns } from "./list.js";

/** Asks for the name, the note and the tags of a run, and stores those that were changed. They are read first, and what another browser
 * has changed meanwhile is shown before it is replaced. */
export async function labelRun(run) {
  const path = recordingPath(run.id);
  let known;
  try {
    known = await call("GET", path);
  } catch (error) {
    notify(`It cannot be named: ${error.message}`);
    return;
  }
  let before = known.label;
  const values = { ...before };
  const problem = signal(null);
  const Body = () => html`<label class="field">Name <input value=${values.name} maxlength="100" onInput=${(event) => (values.name = event.currentTarget.value)} /></label>
    <label class="field">Tags <input value=${values.tags.join(", ")} placeholder="separated by commas" onInput=${(event) => (values.tags = event.currentTarget.value.split(","))} /></label>
    <label class="field">Note <textarea rows="4" maxlength="2000" onInput=${(event) => (values.note = event.currentTarget.value)}>${values.note}</textarea></label>
    <${Problem} text=${problem.value} />`;
  const check = async () => {
    const written = { ...values, tags: values.tags.map((tag) => tag.trim()).filter(Boolean) };
    const changed = Object.entries(written).filter(([field, value]) => String(value) !== String(before[field]));
    await call("POST", `${path}/label`, { ...Object.fromEntries(changed), known: before });
    return true;
  };
  const onError = async (error) => {
    problem.value = error.message;
    const now = error.status === 409 ? await call("GET", path).catch(() => null) : null;
    if (now) {
      before = now.label;
      problem.value += ". Save replaces that.";
    }
  };
  const isSaved = await dialog({ title: "Name of the run", body: html`<${Body} />`, actions: [{ text: "Save", kind: "primary" }], check, onError });
  if (isSaved) await listRuns();
}
