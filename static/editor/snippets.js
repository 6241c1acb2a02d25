// Pieces of models to insert: offered among the completions at the start of a line, and in the menu of the editor.

import { snippet, syntaxTree } from "../vendor/codemirror.js";
import { shownText } from "./language.js";
import { AGENT, BODY, groupOf, importGroups, importLines } from "./templates.js";

const ACTR = "from actr3d.actr import *";

/** {label, detail, needs: imports, source: a template with fields in CodeMirror's form, whole: whether it stands outside of classes}. */
export const SNIPPETS = [
  { label: "agent", detail: "an agent with a production", needs: AGENT.imports, source: AGENT.source, whole: true },
  {
    label: "production",
    detail: "a production",
    needs: [ACTR],
    source: 'def ${name}(goal="${task:start}"):\n\tgoal.set("${task:done}")\n',
  },
  {
    label: "memory",
    detail: "a declarative memory and its buffer",
    needs: [ACTR],
    source: "${retrieval} = Buffer()\n${memory} = Memory(${retrieval})\n",
  },
  {
    label: "vision",
    detail: "vision with the eye of a body, and its buffer",
    needs: [ACTR, "from actr3d.vision import Vision"],
    source: "${visual} = Buffer()\n${vision} = Vision(${visual})\n",
  },
  { label: "motor", detail: "motor control of a body", needs: [ACTR, "from actr3d.motor import Motor"], source: "${motor} = Motor()\n" },
  { label: "body", detail: "an agent with a body in a world", needs: BODY.imports, source: BODY.source, whole: true },
  {
    label: "detector",
    detail: "a detector for the agent's vision",
    needs: ["from dataclasses import dataclass", "from actr3d.vision import DETECTORS, Feature, Metres, detector"],
    whole: true,
    source: `@dataclass(frozen=True, kw_only=True)
class \${Wall}(Feature):
    """\${A wide thing.}"""

    width: Metres


@detector(\${Wall})
def \${walls}(view, *, least: Metres = \${1.0}):
    """Returns all things of at least this width [m]."""
    things = DETECTORS["obstacle"](view)
    return tuple(\${Wall}(distance=one.distance, direction=one.direction, width=one.width) for one in things if one.width >= least)
`,
  },
  {
    label: "experiment",
    detail: "a design of an experiment",
    needs: ["from actr3d.experiment import Design, Group, Measured, Normal, design"],
    whole: true,
    source: `@design
def \${my_design}():
    """\${Say in one line what is compared.}"""
    return Design(
        model="\${my_model.py}",
        factors={"\${width}": [\${0.5, 0.8}]},
        groups={"\${adults}": Group(participants=5, parameters={"\${speed}": Normal(mean=\${1.2}, sd=\${0.1}, low=\${0.5})})},
        trials=10,
        measures=[Measured(name="time", unit="s")],
        results=lambda simulation: {"time": simulation.time},
    )
`,
  },
];

/** What inserts each piece as a completion, at the start of a line. */
export function completionsOf() {
  return SNIPPETS.map((piece) => ({
    label: piece.label,
    type: "text",
    detail: piece.detail,
    boost: 4,
    apply: (view, _, from, to) => insertPiece(view, piece, from, to),
  }));
}

/** Inserts a piece between two positions of the text that is shown, and the imports that it needs. */
export function insertPiece(view, piece, from, to) {
  const source = piece.source.replace("my_model.py", (shownText.path() ?? "my_model.py").split("/").at(-1));
  const missing = piece.needs.filter((line) => !imports(view.state.doc).some(({ text }) => text === line));
  if (missing.length === 0) return snippet(source)(view, null, from, to);
  const changes = view.state.changes(importing(view.state.doc, missing));
  view.dispatch({ changes, userEvent: "input" });
  return snippet(source)(view, null, changes.mapPos(from, 1), changes.mapPos(to, 1));
}

/** Returns the imports at the top level of a text: {text, number, end}, with the numbers of their first and last lines. */
function imports(doc) {
  const lines = [...doc.iterLines()];
  const endOf = (n) => (lines[n].includes("(") ? lines.findIndex((text, at) => at >= n && text.includes(")")) : n);
  return lines.flatMap((text, n) => (/^(from|import)\s/.test(text) ? { text, number: n + 1, end: Math.max(n, endOf(n)) + 1 } : []));
}

const IMPORT = /^(from [\w.]+ import )([\w, ]+)$/;

/** Returns the changes that add imports: names to the line that imports others from their module; the other imports by their groups, each
 * where it belongs among those of the text, or all after the docstring. */
function importing(doc, lines) {
  const known = imports(doc).map((one) => ({ ...one, group: groupOf(one.text) }));
  if (known.length > 0) {
    const joined = [];
    const others = lines.filter((line) => {
      const [, module, names] = IMPORT.exec(line) ?? [];
      const same = module && known.find(({ text }) => text.startsWith(module) && IMPORT.test(text));
      if (!same) return true;
      const missing = names.split(", ").filter((name) => !IMPORT.exec(same.text)[2].split(", ").includes(name));
      if (missing.length > 0) joined.push({ from: doc.line(same.number).to, insert: `, ${missing.join(", ")}` });
      return false;
    });
    const added = importGroups(others).map(({ group, text }) => {
      const before = known.findLast((one) => one.group <= group);
      if (!before) return { from: doc.line(known[0].number).from, insert: `${text}\n\n` };
      return { from: doc.line(before.end).to, insert: `${before.group === group ? "\n" : "\n\n"}${text}` };
    });
    return [...joined, ...added];
  }
  const [docstring = ""] = /^\s*("""[^]*?"""|'''[^]*?''')[^\n]*\n?/.exec(doc.sliceString(0, 20_000)) ?? [];
  return { from: docstring.length, insert: `${docstring ? "\n" : ""}${importLines(lines)}\n\n\n` };
}

const isEmpty = ({ text }) => text.trim() === "";
const indentationOf = ({ text }) => /^\s*/.exec(text)[0];
const PRODUCTION = /^def /;

/** Returns a line, or the first one above it that is not empty. */
function writtenAbove(doc, line) {
  let above = line;
  while (above.number > 1 && isEmpty(above)) above = doc.line(above.number - 1);
  return above;
}

/** Returns the production or other method that the text of a line is in; null if it is in none. */
function methodAt(state, line) {
  let method = null;
  for (let node = syntaxTree(state).resolveInner(line.from + line.text.trimEnd().length, -1); node; node = node.parent) {
    if (node.name === "ClassDefinition") return method;
    if (node.name === "FunctionDefinition") method = node;
  }
  return null;
}

/** Returns where a piece is inserted, {from, to, gap}: `gap` comes before it. */
function placeOf(state, { whole, source }) {
  const { doc, selection } = state;
  let line = doc.lineAt(selection.main.head);
  if (whole) {
    line = doc.line(Math.max(line.number, imports(doc).at(-1)?.end ?? 1)); // what it imports must come before it
    while (line.number < doc.lines && !/^\S/.test(doc.line(line.number + 1).text)) line = doc.line(line.number + 1);
    line = writtenAbove(doc, line);
    return { from: line.to, to: line.to, gap: isEmpty(line) ? "" : "\n\n\n" };
  }
  const method = methodAt(state, writtenAbove(doc, line));
  const indentation = indentationOf(method ? doc.lineAt(method.from) : line);
  if (isEmpty(line) && line.text === indentation) return { from: line.to, to: line.to, gap: "" };
  if (!method) return { from: line.to, to: line.to, gap: `${PRODUCTION.test(source) ? "\n\n" : "\n"}${indentation}` };
  const end = writtenAbove(doc, doc.lineAt(method.to));
  return { from: end.to, to: Math.max(end.to, isEmpty(line) ? line.to : 0), gap: `\n\n${indentation}` };
}

/** Inserts a piece at the cursor: in its line if that is empty, otherwise below; what stands outside of classes, below the class or
 * function that the cursor is in; what belongs to a class, below the production that the cursor is in. */
export function insertAtCursor(view, piece) {
  const { from, to, gap } = placeOf(view.state, piece);
  const { doc } = view.state;
  const next = doc.lineAt(to).number + 1;
  const needsRoom = piece.whole || gap === "" || (PRODUCTION.test(piece.source) && next <= doc.lines && !isEmpty(doc.line(next)));
  view.dispatch({ changes: { from, to, insert: gap }, userEvent: "input" });
  insertPiece(view, needsRoom ? piece : { ...piece, source: piece.source.trimEnd() }, from + gap.length, from + gap.length);
  view.focus();
}
