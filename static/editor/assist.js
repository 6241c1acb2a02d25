// Help while writing: completions, documentation under the pointer, and the parameters of the call around the cursor.

import {
  autocompletion,
  EditorView,
  hoverTooltip,
  insertCompletionText,
  keymap,
  pickedCompletion,
  Prec,
  showTooltip,
  snippet,
  startCompletion,
  StateEffect,
  StateField,
  syntaxTree,
} from "../vendor/codemirror.js";
import { helpWith } from "./language.js";
import { completionsOf, insertPiece } from "./snippets.js";

const PAUSE = 150; // after a change, before the parameters of a call are asked for again [ms]
const HOVER = 350; // [ms]
const LONG = 500; // how long one waits for completions before the page shows that they are on their way [ms]

// -- completions

/** Returns what is around a position: `code`, the `head` of a function, a `call` of what a part can do, such as `goal.modify(`, `text` of chunks or
 * patterns, or `other` text and comments. */
function around(state, at) {
  let node = syntaxTree(state).resolveInner(at, -1);
  if (node.name === "Comment") return "other";
  let inText = false;
  for (; node; node = node.parent) {
    if (node.name === "FormatReplacement") return "code";
    if (/String/.test(node.name)) inText = true;
    if (/^(ParamList|ArgList)$/.test(node.name)) return inText ? "text" : node.name === "ParamList" ? "head" : node.prevSibling?.name === "MemberExpression" ? "call" : "code";
    if (/^(Body|Script)$/.test(node.name)) break;
  }
  return inText ? "other" : "code";
}

const TYPED = { code: /[\w.]$/, head: /[\w.(, ]$/, call: /[\w.(, ]$/, text: /[\w?!.:"' ]$/ };

async function complete(context) {
  const { state, pos, explicit } = context;
  const place = around(state, pos);
  if (place === "other" || !(explicit || context.matchBefore(TYPED[place]))) return null;
  const answer = await shownAsReading(context, helpWith(state, "complete", pos));
  const word = context.matchBefore(/\w+$/);
  let items = answer?.items ?? [];
  const unasked = !word && !explicit;
  if (place === "head" && unasked) items = items.filter(({ apply }) => apply); // only the parts of the agent
  if (place === "call" && unasked && context.matchBefore(/[(, ]$/)) items = items.filter(({ label, detail }) => detail && label.endsWith("=")); // only slots
  const options = [...items.map((item) => option(item, state, pos)), ...(place === "code" && isLineStart(state, pos) ? completionsOf() : [])];
  if (options.length > 0) return { from: answer?.start ?? word?.from ?? pos, options, validFor: /^\??\w*$/ };
  // After null, CodeMirror would not ask again for what has been typed meanwhile; after options that are valid no more, it does.
  return context.view.state.doc === state.doc ? null : { from: pos, options, validFor: () => false };
}

/** Waits for an answer about a position; if it takes long, a box shows there meanwhile that the text is being read. */
async function shownAsReading({ view, state, pos }, asked) {
  let reading = null;
  const timer = setTimeout(() => {
    if (view.state.doc !== state.doc || view.state.selection.main.head !== pos || view.state.field(box) || !view.dom.isConnected) return;
    reading = { call: false, waits: true, pos, dom: Object.assign(document.createElement("div"), { className: "reading", role: "status", textContent: "Reading the text …" }) };
    view.dispatch({ effects: showBox.of(reading) });
  }, LONG);
  const answer = await asked;
  clearTimeout(timer);
  if (reading && view.state.field(box) === reading) hideBox(view);
  return answer;
}

function isLineStart(state, at) {
  const line = state.doc.lineAt(at);
  return /^\s*\w*$/.test(line.text.slice(0, at - line.from));
}

function option(item, state, at) {
  const { label, type, detail, boost, text, needs } = item;
  return {
    label,
    type,
    detail,
    boost,
    apply: needs ? (view, _, from, to) => insertPiece(view, { source: item.apply, needs: [needs] }, from, to) : item.apply ? applied(item.apply) : undefined,
    info: async () => {
      const said = text ? { title: "", text } : await helpWith(state, "document item", at, label);
      return said && (said.title || said.text) ? { dom: documentation(said) } : null;
    },
  };
}

/** Returns what inserts a completion: a template with fields, or a text; after a slot's name, its values are offered. */
function applied(inserted) {
  if (inserted.includes("${")) return snippet(inserted);
  return (view, completion, from, to) => {
    const next = view.state.sliceDoc(to, to + 1);
    const text = /[:=]$/.test(inserted) && next === inserted.at(-1) ? inserted.slice(0, -1) : inserted;
    view.dispatch({ ...insertCompletionText(view.state, text, from, to), annotations: pickedCompletion.of(completion) });
    if (text.endsWith(":")) startCompletion(view);
  };
}

// -- documentation

function documentationBox() {
  return Object.assign(document.createElement("div"), { className: "documentation", role: "note", ariaLabel: "Documentation", tabIndex: 0 }); // it may have to be scrolled
}

/** Returns the text of a documentation as an element; what stands between backticks is code. Where a docstring breaks a long line, the text
 * goes on: the box has its own width. */
function paragraph(text) {
  const box = document.createElement("p");
  text.replace(/(.{60,})\n *(?![\s*-]|[\w*]+: )/g, "$1 ").split(/`+([^`]+)`+/).forEach((part, n) => box.append(n % 2 ? Object.assign(document.createElement("code"), { textContent: part }) : part));
  return box;
}

/** Returns documentation as an element; everything in it is text. */
function documentation({ title, text }) {
  const box = documentationBox();
  if (title) box.append(Object.assign(document.createElement("pre"), { textContent: title }));
  if (text) box.append(paragraph(text));
  return box;
}

const hover = hoverTooltip(
  async (view, at) => {
    const found = await helpWith(view.state, "document", at);
    return found ? { pos: found.start, end: found.end, above: true, create: () => ({ dom: documentation(found) }) } : null;
  },
  { hoverTime: HOVER },
);

// -- the box at the cursor: the parameters of a call, or documentation that was asked for by a key

const showBox = StateEffect.define();

/** {call, pos, dom}: whether it shows the parameters of a call, its place and its content; null for none. */
const box = StateField.define({
  create: () => null,
  update(now, transaction) {
    for (const effect of transaction.effects) if (effect.is(showBox)) return effect.value;
    if (now === null || (!transaction.docChanged && !transaction.selection)) return now;
    return now.call ? { ...now, pos: transaction.changes.mapPos(now.pos) } : null;
  },
  provide: (field) => showTooltip.from(field, (now) => now && { pos: now.pos, above: true, create: () => ({ dom: now.dom }) }),
});

function parametersOf({ name, parameters, active, text }) {
  const dom = documentationBox();
  const line = document.createElement("pre");
  line.append(`${name}(`);
  parameters.forEach((parameter, n) => {
    if (n > 0) line.append(", ");
    line.append(n === active ? Object.assign(document.createElement("b"), { textContent: parameter }) : parameter);
  });
  line.append(")");
  dom.append(line);
  if (text) dom.append(paragraph(text));
  return dom;
}

/** Shows the parameters of the call around the cursor, or hides the box if there is none; returns whether there is one. */
async function showCall(view) {
  const { state } = view;
  const at = state.selection.main.head;
  const [found] = (await helpWith(state, "signature", at)) ?? [];
  if (view.state.doc !== state.doc || view.state.selection.main.head !== at) {
    if (found) followSoon(view); // more has been written meanwhile
    return Boolean(found);
  }
  if (found || state.field(box, false)?.call) view.dispatch({ effects: showBox.of(found ? { call: true, pos: at, dom: parametersOf(found) } : null) });
  return Boolean(found);
}

/** Shows what is known at the cursor: the parameters of the call around it, or otherwise the documentation of the name. */
export async function showHelp(view) {
  const { state } = view;
  const at = state.selection.main.head;
  const said = await shownAsReading({ view, state, pos: at }, helpWith(state, "document", at));
  if (view.state.doc !== state.doc || view.state.selection.main.head !== at) return;
  if (said) view.dispatch({ effects: showBox.of({ call: false, pos: said.start, dom: documentation(said) }) });
  else await showCall(view);
}

let timer = null;
const followCall = EditorView.updateListener.of(({ view, state, transactions, docChanged, selectionSet }) => {
  if (!docChanged && !selectionSet) return;
  const opens = transactions.some((one) => one.isUserEvent("input") && /[(,]/.test(inserted(one)));
  if (!opens && !state.field(box, false)?.call) return;
  followSoon(view);
});

function followSoon(view) {
  clearTimeout(timer);
  timer = setTimeout(showCall, PAUSE, view);
}

function inserted({ changes }) {
  let text = "";
  changes.iterChanges((_, __, ___, ____, part) => (text += part.toString()));
  return text.length < 10 ? text : "";
}

function hideBox(view) {
  if (!view.state.field(box, false)) return false;
  view.dispatch({ effects: showBox.of(null) });
  return true;
}

/** Hides the box of an answer that is waited for; the key then goes on to what waits. */
function hideReading(view) {
  if (view.state.field(box, false)?.waits) hideBox(view);
  return false;
}

let warmed = false;

/** Lets the server load what it needs for its answers when a text is first shown, so that the first completion comes at once. */
export function warm(state) {
  if (!warmed) helpWith(state, "complete", state.doc.length);
  warmed = true;
}

export const assist = [
  Prec.highest(keymap.of([{ key: "Escape", run: hideReading }])), // before that of the completions
  autocompletion({ override: [complete], icons: true, maxRenderedOptions: 60 }),
  hover,
  box,
  followCall,
  Prec.high(
    keymap.of([
      { key: "Escape", run: hideBox },
      { key: "Mod-Shift-Space", run: (view) => (showHelp(view), true) },
    ]),
  ),
];
