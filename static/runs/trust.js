// Code of recordings and experiments that were made elsewhere: runs only after the user has seen its origin and agreed.

import { dialog } from "../parts/dialog.js";
import { call } from "../server.js";
import { html } from "../vendor/preact.js";

const UNTRUSTED = 403;

/**
 * Performs an action that runs the code of a recording or an experiment; if the server refuses this for one that was made elsewhere, asks
 * the user first. Returns the result of `work`, or null if the user declines.
 *
 * @param id The recording or experiment.
 * @param doing The name of the action, as in «Open it».
 * @param work Performs it; called with whether the code may run regardless of its origin.
 * @param kind "recordings" or "experiments".
 */
export async function withTrust(id, doing, work, kind = "recordings") {
  try {
    return await work(false);
  } catch (error) {
    if (error.status !== UNTRUSTED) throw error;
  }
  const code = await call("GET", `/api/${kind}/${encodeURIComponent(id)}/code`);
  return (await agreed(id, doing, code, kind.slice(0, -1))) ? work(true) : null;
}

function agreed(id, doing, { file, source, helpers }, noun) {
  const texts = [[file, source], ...Object.entries(helpers)];
  const body = html`<div class="foreign">
    <p>This installation did not make the ${noun} <span class="mono">${id}</span>, or it was changed since. ${doing} runs the code that it holds, with your rights and on your files. Go on only if you know where it comes from.</p>
    ${texts.map(([name, text], n) => html`<details key=${name} open=${n === 0}><summary class="mono">${name}</summary><pre tabindex="0" aria-label=${`Code of ${name}`}>${text}</pre></details>`)}
  </div>`;
  return dialog({ title: noun === "recording" ? "A recording from elsewhere" : "An experiment from elsewhere", body, actions: [{ text: "Run its code", kind: "danger" }] });
}
