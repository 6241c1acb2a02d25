// The menu of the editor: what its keys do, and pieces of models to insert.

import { gotoLine, openSearchPanel, startCompletion } from "../vendor/codemirror.js";
import { html, useId, useRef } from "../vendor/preact.js";
import { keyText } from "../keys.js";
import { Button } from "../parts/button.js";
import { Icon } from "../parts/icon.js";
import { showHelp } from "./assist.js";
import { keys, withView } from "./code.js";
import { insertAtCursor, SNIPPETS } from "./snippets.js";

/** The actions: {text, key, work}; the keys are those of code.js, assist.js and CodeMirror. */
export const ACTIONS = [
  { text: "Complete", key: "Ctrl+Space", work: () => withView(startCompletion) },
  { text: "Documentation", key: "Mod+Shift+Space", work: () => withView(showHelp) },
  { text: "Go to the definition", key: "F12", work: () => keys.define() },
  { text: "Rename …", key: "F2", work: () => keys.rename() },
  { text: "Format", key: "Shift+Alt+F", work: () => keys.format() },
  { text: "Find and replace …", key: "Mod+F", work: () => withView(openSearchPanel) },
  { text: "Go to a line …", key: "Mod+Alt+G", work: () => withView(gotoLine) },
];

/** What inserts a piece at the cursor: {text, work}. */
export const INSERTIONS = SNIPPETS.map((piece) => ({ text: piece.detail, work: () => withView((view) => insertAtCursor(view, piece)) }));

/** @param disabled Whether there is no text. */
export function Menu({ disabled }) {
  const id = useId();
  const button = useRef(null);
  const menu = useRef(null);

  function place(event) {
    if (event.newState !== "open") return;
    const { right, bottom } = button.current.getBoundingClientRect();
    Object.assign(menu.current.style, { left: "auto", right: `${innerWidth - right}px`, top: `${bottom + 2}px` });
  }

  function choose(work) {
    menu.current.hidePopover();
    work();
  }

  return html`<${Button} button=${button} class="bare" popovertarget=${id} disabled=${disabled} title="More: definition, rename, format, insert" aria-label="More"><${Icon} name="more" /><//>
    <div ref=${menu} id=${id} popover="auto" class="editor-menu" role="group" aria-label="More" onBeforeToggle=${place}>
      ${ACTIONS.map(({ text, key, work }) => html`<button key=${text} class="bare" onClick=${() => choose(work)}><span>${text}</span><kbd>${keyText(key)}</kbd></button>`)}
      <p>Insert</p>
      ${INSERTIONS.map(({ text, work }) => html`<button key=${text} class="bare" onClick=${() => choose(work)}><span>${text}</span></button>`)}
    </div>`;
}
