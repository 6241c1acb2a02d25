// The page's use of CodeMirror: one view, which shows one of the open texts at a time.

import {
  autocompletion,
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
import { look } from "./look.js";
import { marking } from "./marks.js";
import { complete } from "./completions.js";

/** The actions of the editor's own keys; panels/editor.js fills it in. */
export const keys = { run: () => {}, save: () => {} };

let view = null;
let inView = null;

const language = python();
const own = Prec.highest(
  keymap.of([
    { key: "Mod-Enter", run: () => (keys.run(), true) },
    { key: "Mod-s", run: () => (keys.save(), true) },
  ]),
);

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
  language.language.data.of({ autocomplete: complete }),
  autocompletion(),
  bracketMatching(),
  closeBrackets(),
  highlightActiveLine(),
  highlightActiveLineGutter(),
  highlightSelectionMatches(),
  search({ top: true }),
  look,
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
  view ??= new EditorView({ state: document.state, dispatchTransactions: taken });
  if (inView !== document) {
    finishMeasuring();
    leaveText();
    inView = document;
    view.setState(document.state);
    const name = `Text of ${document.path}. Escape, then Tab, leaves it.`;
    view.contentDOM.setAttribute("aria-label", name);
    view.contentDOM.tabIndex = 0;
  }
  if (view.dom.parentNode !== place) place.append(view.dom);
  view.requestMeasure();
  view.scrollDOM.scrollTop = document.scroll;
  if (document.revealed !== null) scrollToRevealed();
}

/** Lets CodeMirror measure what it has put off to the next frame. `setState` keeps such requests, for example to place the list of
 * completions, which then look for positions of the former text in the new one and raise a RangeError. */
function finishMeasuring() {
  view.elementAtHeight(0); // any question about the layout does it
}

/** Stores the scroll position of a text before it is hidden. */
export function leaveText() {
  if (inView && view?.dom.isConnected) inView.scroll = view.scrollDOM.scrollTop;
}

function taken(transactions) {
  view.update(transactions);
  inView.took(transactions);
}

/** Moves to a line of the text that is shown. */
export function goTo(line) {
  const place = view.state.doc.line(Math.max(1, Math.min(line, view.state.doc.lines)));
  view.dispatch({ selection: EditorSelection.cursor(place.from), effects: EditorView.scrollIntoView(place.from, { y: "center" }) });
  focusText();
}

/** Moves the focus into the text, unless the user may be typing in a field by now. */
export function focusText() {
  if (!document.activeElement?.matches("input, select, textarea")) view?.focus();
}
