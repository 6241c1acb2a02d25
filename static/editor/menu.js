// The menu of the editor: what its keys do, and pieces of models to insert.

import { gotoLine, openSearchPanel, startCompletion } from "../vendor/codemirror.js";
import { html } from "../vendor/preact.js";
import { keyText } from "../keys.js";
import { Icon } from "../parts/icon.js";
import { Menu } from "../parts/menu.js";
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
export function EditorMenu({ disabled }) {
  return html`<${Menu} class="editor-menu" label="More" title="More: definition, rename, format, insert" face=${html`<${Icon} name="more" />`} disabled=${disabled}>
    ${(toggle) => {
      const entry = ({ text, key, work }) => html`<button key=${text} onClick=${() => (toggle(false), work())}><span>${text}</span>${key ? html`<kbd>${keyText(key)}</kbd>` : null}</button>`;
      return html`${ACTIONS.map(entry)}<p>Insert</p>${INSERTIONS.map(entry)}`;
    }}
  <//>`;
}
