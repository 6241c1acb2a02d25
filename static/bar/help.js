// The keys, shown by `?`.

import { html } from "../vendor/preact.js";
import { bindKey, KEY_GROUPS, keysOf, keyText } from "../keys.js";
import { dialog } from "../parts/dialog.js";

export function showKeys() {
  const groups = KEY_GROUPS.map(
    (group) => html`<section key=${group}>
      <h3 id="keys-${group}">${group}</h3>
      <table aria-labelledby="keys-${group}"><tbody>${keysOf(group).map(({ key, text }) => html`<tr key=${text}><td><kbd>${keyText(key)}</kbd></td><td>${text}</td></tr>`)}</tbody></table>
    </section>`,
  );
  dialog({ title: "Keys", body: html`<div class="keys">${groups}</div>` });
}

bindKey("?", "Show the keys", showKeys, "Panels");
