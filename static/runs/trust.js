// Code of recordings that were made elsewhere: it is run only after the user has seen whose it is, and agreed.

import { dialog } from "../parts/dialog.js";
import { call } from "../server.js";
import { html } from "../vendor/preact.js";

const UNTRUSTED = 403;

/**
 * Does something that runs the code of a recording; where the server refuses that for a recording that was made elsewhere, asks
 * the user first. Returns what `work` returns, or null where the user does not agree.
 *
 * @param id The recording.
 * @param doing What is to be done with it, as in «Open it».
 * @param work Does it; called with whether the code may be run whoever has made it.
 */
export async function withTrust(id, doing, work) {
  try {
    return await work(false);
  } catch (error) {
    if (error.status !== UNTRUSTED) throw error;
  }
  const code = await call("GET", `/api/recordings/${encodeURIComponent(id)}/code`);
  return (await agreed(id, doing, code)) ? work(true) : null;
}

function agreed(id, doing, { file, source, helpers }) {
  const texts = [[file, source], ...Object.entries(helpers)];
  const body = html`<div class="foreign">
    <p>This installation did not make the recording <span class="mono">${id}</span>, or it was changed since. ${doing} runs the code that it holds, with your rights and on your files. Go on only if you know where it comes from.</p>
    ${texts.map(([name, text], n) => html`<details key=${name} open=${n === 0}><summary class="mono">${name}</summary><pre tabindex="0" aria-label=${`Code of ${name}`}>${text}</pre></details>`)}
  </div>`;
  const actions = [{ text: "Cancel", value: false }, { text: "Run its code", value: true, kind: "danger" }];
  return dialog({ title: "A recording from elsewhere", body, actions });
}
