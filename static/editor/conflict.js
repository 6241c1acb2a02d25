// A file that has changed on disk while its text was edited here: shows both versions, and the user chooses.

import { html, useEffect, useRef } from "../vendor/preact.js";
import { EditorState, EditorView, lineNumbers, unifiedMergeView } from "../vendor/codemirror.js";
import { codeTheme } from "./code_theme.js";

const FOLD = { margin: 3, minSize: 6 };

/** @param document The text, with `theirs`. @param choose Called with "mine", "theirs" or "edit". */
export function Conflict({ document, choose }) {
  const place = useRef(null);
  const first = useRef(null);
  const theirs = document.theirs.value;
  useEffect(() => {
    const view = new EditorView({
      parent: place.current,
      doc: document.text,
      extensions: [
        lineNumbers(),
        EditorView.lineWrapping, // differences may be far to the right
        codeTheme, // without the colours of the language, which are not readable on every background
        EditorState.readOnly.of(true),
        EditorView.contentAttributes.of({ "aria-label": "Both texts", tabindex: "0" }),
        unifiedMergeView({ original: theirs.text, mergeControls: false, collapseUnchanged: FOLD }),
      ],
    });
    first.current.focus();
    return () => view.destroy();
  }, [theirs]);
  return html`<div class="conflict" role="group" aria-label="Conflict">
    <p>
      <b>${document.path}</b> has changed on disk since it was read here. Lines with <span class="mine">+</span> are yours, lines
      with <span class="theirs">−</span> are those on disk. Nothing is written until you choose.
    </p>
    <div class="code" ref=${place}></div>
    <footer class="tools">
      <button onClick=${() => choose("mine")}>Keep mine</button>
      <button onClick=${() => choose("theirs")}>Take theirs</button>
      <button ref=${first} onClick=${() => choose("edit")}>Keep editing</button>
      <span class="quiet">«Keep mine» writes over what is on disk.</span>
    </footer>
  </div>`;
}
