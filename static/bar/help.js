// The keys, shown by `?`.

import { html } from "../vendor/preact.js";
import { bindKey, boundKeys, keyText } from "../keys.js";
import { dialog } from "../parts/dialog.js";

export function showKeys() {
  const rows = boundKeys().map(({ key, text }) => html`<tr><td><kbd>${keyText(key)}</kbd></td><td>${text}</td></tr>`);
  dialog({ title: "Keys", body: html`<table class="keys"><tbody>${rows}</tbody></table>` });
}

bindKey("?", "Show the keys", showKeys);
