// The page's use of CodeMirror: a view, which shows one of the open texts at a time.

import {
  bracketMatching,
  closeBrackets,
  closeBracketsKeymap,
  completionKeymap,
  defaultKeymap,
  drawSelection,
  dropCursor,
  EditorSelection,
  EditorState,
  EditorView,
  foldGutter,
  foldKeymap,
  highlightActiveLine,
  highlightActiveLineGutter,
  highlightSelectionMatches,
  highlightSpecialChars,
  history,
  historyKeymap,
  indentOnInput,
  indentUnit,
  indentWithTab,
  keymap,
  lineNumbers,
  lintGutter,
  lintKeymap,
  Prec,
  python,
  search,
  searchKeymap,
} from "../vendor/codemirror.js";
import { codeTheme } from "./code_theme.js";
import { hasMod } from "../keys.js";
import { marking } from "./marks.js";
import { assist, warm } from "./assist.js";
import { shownText } from "./language.js";

/** The actions of the editor's own keys; panels/editor.js fills it in. */
export const keys = { run: () => {}, save: () => {}, define: () => {}, rename: () => {}, format: () => {} };

let view = null;
let inView = null;
shownText.path = () => inView?.path ?? null;

const language = python();
const own = Prec.highest(
  keymap.of([
    { key: "Mod-Enter", run: () => (keys.run(), true) },
    { key: "Mod-s", run: () => (keys.save(), true) },
    { key: "F12", run: () => (keys.define(), true) },
    { key: "F2", run: () => (keys.rename(), true) },
    { key: "Shift-Alt-f", run: () => (keys.format(), true) },
  ]),
);

/** The texts of CodeMirror's panels, in the style of the page. */
const PHRASES = {
  next: "Next",
  previous: "Previous",
  all: "All",
  "match case": "Match case",
  regexp: "Regular expression",
  "by word": "Whole words",
  replace: "Replace",
  "replace all": "Replace all",
  go: "Go",
};

const EXTENSIONS = [
  own,
  lineNumbers(),
  foldGutter(),
  lintGutter(),
  marking,
  history(),
  highlightSpecialChars(),
  drawSelection(),
  dropCursor(),
  EditorState.allowMultipleSelections.of(true),
  EditorState.tabSize.of(4),
  indentUnit.of("    "),
  indentOnInput(),
  language,
  assist,
  bracketMatching(),
  closeBrackets(),
  highlightActiveLine(),
  highlightActiveLineGutter(),
  highlightSelectionMatches(),
  search({ top: true }),
  EditorState.phrases.of(PHRASES),
  EditorView.lineWrapping,
  codeTheme,
  EditorView.contentAttributes.of({ tabindex: "0", "data-focus": "" }), // what can be scrolled can be reached; a command that opens the tab leads here
  EditorView.clickAddsSelectionRange.of((event) => event.altKey), // Ctrl and click goes to a definition
  EditorView.domEventHandlers({
    mousedown(event, view) {
      const at = hasMod(event) && event.button === 0 ? view.posAtCoords({ x: event.clientX, y: event.clientY }) : null;
      if (at === null) return false;
      view.dispatch({ selection: EditorSelection.cursor(at) });
      keys.define();
      return true;
    },
  }),
  keymap.of([...closeBracketsKeymap, ...completionKeymap, ...lintKeymap, ...searchKeymap, ...historyKeymap, ...foldKeymap, ...defaultKeymap, indentWithTab]),
];

/** Returns the initial state of an opened text. */
export function freshState(text) {
  return EditorState.create({ doc: text, extensions: EXTENSIONS });
}

/** Gives documents access to the view, if it shows them. */
export const watchText = {
  dispatch(document, spec) {
    if (inView !== document || !view) return false;
    view.dispatch(spec);
    return true;
  },
};

/** Scrolls a position of a text into view without moving the cursor or the focus; if the text is hidden, when it is shown
 * again. */
export function reveal(document, at) {
  document.revealed = at;
  if (inView === document && view?.dom.isConnected && view.dom.offsetHeight > 0) scrollToRevealed();
}

function scrollToRevealed() {
  const at = Math.min(inView.revealed, view.state.doc.length);
  inView.revealed = null;
  view.dispatch({ effects: EditorView.scrollIntoView(at, { y: "center" }) });
}

/** Shows a text in an element of the page. */
export function showText(place, document) {
  const focused = view?.hasFocus;
  const isOther = inView !== document;
  if (isOther) {
    leaveText();
    view?.destroy();
    inView = document;
    view = made(document);
    warm(view.state);
  }
  if (view.dom.parentNode !== place) place.append(view.dom);
  if (isOther && focused) view.focus();
  view.requestMeasure();
  view.scrollDOM.scrollTop = document.scroll;
  if (document.revealed !== null) scrollToRevealed();
}

/** Returns a view of a text. Each text has a new one: what a view has begun, such as to ask for completions, would go on with positions
 * of the former text in the next one. */
function made(document) {
  const editor = new EditorView({ state: document.state, dispatchTransactions: taken });
  editor.contentDOM.setAttribute("aria-label", `Text of ${document.path}. Escape, then Tab, leaves it.`);
  editor.contentDOM.tabIndex = 0;
  let height = 0;
  // Where a list of problems appears below, the line that is being written stays in view.
  new ResizeObserver(() => {
    const before = height;
    const { top, bottom } = editor.scrollDOM.getBoundingClientRect();
    height = bottom - top;
    const cursor = editor.hasFocus && height > 0 && height < before ? editor.coordsAtPos(editor.state.selection.main.head) : null;
    if (cursor && cursor.bottom > bottom && cursor.top < top + before) editor.dispatch({ effects: EditorView.scrollIntoView(editor.state.selection.main) });
  }).observe(editor.scrollDOM);
  return editor;
}

/** Stores the scroll position of a text before it is hidden. */
export function leaveText() {
  if (inView && view?.dom.isConnected) inView.scroll = view.scrollDOM.scrollTop;
}

function taken(transactions, by) {
  by.update(transactions);
  if (by === view) inView.took(transactions); // else it is a former view, which something late has reached
}

/** Moves to a line of the text that is shown. */
export function goToLine(line) {
  const { doc } = view.state;
  goToPosition(doc.line(Math.max(1, Math.min(line, doc.lines))).from);
}

/** Moves the cursor to a position of the text that is shown. */
export function goToPosition(at) {
  const place = Math.min(at, view.state.doc.length);
  view.dispatch({ selection: EditorSelection.cursor(place), effects: EditorView.scrollIntoView(place, { y: "center" }), userEvent: "select" });
  focusText();
}

/** Opens a panel or starts an action of the editor itself, such as the search, on the text that is shown. */
export function withView(work) {
  view.focus();
  work(view);
}

/** Moves the focus into the text, unless the user may be typing in a field by now. */
export function focusText() {
  if (!document.activeElement?.matches("input, select, textarea")) view?.focus();
}
