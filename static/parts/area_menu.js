// The menu of a part of the page: maximise, collapse, open in a window of its own, swap the sides.

import { html } from "../vendor/preact.js";
import { run } from "../commands.js";
import { buttonTitle, keyText } from "../keys.js";
import { AREAS, layoutCommands, maximised, swap } from "../layout.js";
import { alone } from "../address.js";
import { Icon } from "./icon.js";
import { Menu } from "./menu.js";

/** @param area The part. @param opening The command that opens it in a window of its own. */
export function AreaMenu({ area, opening }) {
  if (alone !== null) return null;
  const { maximise, collapse } = layoutCommands[area];
  const entries = [[maximise, maximised.value === area ? "Restore the layout" : "Maximise"], [collapse, "Collapse"], [opening, "Open in a window"], [swap, "Swap the sides"]];
  return html`<${Menu} class="area-menu" label="Arrange: ${AREAS[area]}" face=${html`<${Icon} name="layout" />`}>
    ${(toggle) => entries.filter(([one]) => one.ready()).map(([one, text]) => html`<button key=${text} title=${buttonTitle(one)} onClick=${() => (toggle(false), run(one))}><span>${text}</span>${one.key ? html`<kbd>${keyText(one.key)}</kbd>` : null}</button>`)}
  <//>`;
}
