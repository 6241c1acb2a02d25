// The name, the note and the tags of a recording, which users give.

import { dialog } from "../parts/dialog.js";
import { Problem } from "../parts/problem.js";
import { call } from "../server.js";
import { complain } from "../store.js";
import { html, signal } from "../vendor/preact.js";
import { listRuns } from "./list.js";

/** Asks for the name, the note and the tags of a run, and stores them. They are read first: another browser may have changed them. */
export async function labelRun(run) {
  const path = `/api/recordings/${encodeURIComponent(run.id)}`;
  let known;
  try {
    known = await call("GET", path);
  } catch (error) {
    complain(`It cannot be named: ${error.message}`);
    return;
  }
  const values = { ...known.label };
  const problem = signal(null);
  const Body = () => html`<label class="field">Name <input value=${values.name} maxlength="100" onInput=${(event) => (values.name = event.currentTarget.value)} /></label>
    <label class="field">Tags <input value=${values.tags.join(", ")} placeholder="separated by commas" onInput=${(event) => (values.tags = event.currentTarget.value.split(","))} /></label>
    <label class="field">Note <textarea rows="4" maxlength="2000" onInput=${(event) => (values.note = event.currentTarget.value)}>${values.note}</textarea></label>
    <${Problem} text=${problem.value} />`;
  const check = async () => {
    try {
      const tags = values.tags.map((tag) => tag.trim()).filter(Boolean);
      await call("POST", `${path}/label`, { name: values.name, note: values.note, tags });
      return true;
    } catch (error) {
      problem.value = error.message;
      return false;
    }
  };
  const actions = [{ text: "Cancel", value: null }, { text: "Keep", value: true, kind: "primary" }];
  if (await dialog({ title: "Name of the run", body: html`<${Body} />`, actions, check })) await listRuns();
}
