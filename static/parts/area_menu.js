// The menu of a part of the page: maximise, collapse, open in a window of its own, swap the sides.

import { html, useId, useRef } from "../vendor/preact.js";
import { run } from "../commands.js";
import { buttonTitle, keyText } from "../keys.js";
import { AREAS, layoutCommands, maximised, swap } from "../layout.js";
import { alone } from "../windows.js";
import { Icon } from "./icon.js";

const [WIDTH, HEIGHT] = [210, 130]; // of a menu, at most [px]

/** @param area The part. @param opening The command that opens it in a window of its own. */
export function AreaMenu({ area, opening }) {
  const id = useId();
  const button = useRef(null);
  const menu = useRef(null);
  if (alone !== null) return null;
  const { maximise, collapse } = layoutCommands[area];
  const entries = [[maximise, maximised.value === area ? "Restore the layout" : "Maximise"], [collapse, "Collapse"], [opening, "Open in a window"], [swap, "Swap the sides"]];

  function place(event) {
    if (event.newState !== "open") return;
    const { right, top, bottom } = button.current.getBoundingClientRect();
    const above = bottom + HEIGHT > innerHeight;
    Object.assign(menu.current.style, { left: `${Math.max(4, right - WIDTH)}px`, top: above ? "auto" : `${bottom + 2}px`, bottom: above ? `${innerHeight - top + 2}px` : "auto" });
  }

  function choose(one) {
    menu.current.hidePopover();
    run(one);
  }

  return html`<button ref=${button} class="bare area-menu-button" popovertarget=${id} title="Arrange: ${AREAS[area]}" aria-label="Arrange: ${AREAS[area]}"><${Icon} name="layout" /></button>
    <div ref=${menu} id=${id} popover="auto" class="area-menu" role="group" aria-label="Arrange: ${AREAS[area]}" onBeforeToggle=${place}>
      ${entries.filter(([one]) => one.ready()).map(([one, text]) => html`<button key=${text} class="bare" title=${buttonTitle(one)} onClick=${() => choose(one)}><span>${text}</span>${one.key ? html`<kbd>${keyText(one.key)}</kbd>` : null}</button>`)}
    </div>`;
}
