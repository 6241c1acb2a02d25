// The help, opened by `?`: a link to the manual, and the keys.

import { html } from "../vendor/preact.js";
import { command } from "../commands.js";
import { KEY_GROUPS, keysOf, keyText } from "../keys.js";
import { dialog } from "../parts/dialog.js";

function showHelp() {
  const groups = KEY_GROUPS.filter((group) => keysOf(group).length > 0).map(
    (group, n) => html`<section key=${group}>
      <h3 id="keys-${n}">${group}</h3>
      <table aria-labelledby="keys-${n}"><tbody>${keysOf(group).map(({ key, text }) => html`<tr key=${text}><td><kbd>${keyText(key)}</kbd></td><td>${text}</td></tr>`)}</tbody></table>
    </section>`,
  );
  const manual = html`<p><a href="/manual/" target="_blank" rel="noopener">Manual of ACT-R 3D</a> (<a href="/manual/workbench/" target="_blank" rel="noopener">the workbench</a>)</p>`;
  dialog({ title: "Help", body: html`${manual}<div class="keys" tabindex="0" role="region" aria-label="Keys">${groups}</div>` });
}

/** The command that opens it. */
export const help = command({ text: "Help: the manual and the keys", key: "?", group: "Page", work: showHelp });
