// Events as text: groups of kinds, and each event as a line.

import { chunkText, valueText } from "../parts/chunk.js";
import { commandText } from "../timeline/commands.js";

/** The groups of events in the trace's filter: {id, text, kinds, first: whether they are shown by default}. */
export const GROUPS = [
  { id: "fire", text: "Firings", kinds: ["fire", "changed"], first: true },
  { id: "output", text: "Prints", kinds: ["output"], first: true },
  { id: "reward", text: "Rewards", kinds: ["reward"], first: true },
  { id: "compile", text: "Compiled productions", kinds: ["compile"], first: true },
  { id: "command", text: "User's commands", kinds: ["command"], first: true },
  { id: "contact", text: "Contacts and results", kinds: ["contact", "result"], first: true },
  { id: "plan", text: "Plans (SGOMS)", kinds: ["planning_unit", "unit_task", "method", "operator"], first: true },
  { id: "choice", text: "Choices", kinds: ["select", "conflict"], first: false },
  { id: "buffer", text: "Buffers", kinds: ["buffer"], first: false },
  { id: "memory", text: "Memory", kinds: ["retrieval", "add", "chunks"], first: false },
  { id: "request", text: "Requests and answers", kinds: ["request", "answer"], first: false },
  { id: "vision", text: "Vision", kinds: ["search", "sight"], first: false },
  { id: "motor", text: "Movements", kinds: ["move", "moved", "refused"], first: false },
  { id: "learning", text: "Learned utilities", kinds: ["utility"], first: false },
  { id: "state", text: "Attributes", kinds: ["state", "observe"], first: false },
  { id: "run", text: "Beginnings and ends", kinds: ["start", "run", "stop", "initialize", "productions", "added", "removed"], first: false },
];

const TEXTS = {
  changed: (data) => ["no longer", `${data.production} was chosen, but matches no longer`],
  output: (data) => ["prints", data.text],
  reward: (data) => ["reward", valueText(data.value)],
  compile: (data) => ["compiled", `${data.production} from ${(data.parents ?? []).join(" and ")}`],
  command: (_data, event) => ["user", commandText(event).join(" ")],
  contact: ({ force, lasts }) => ["touch", `begins: ${(1000 * lasts).toFixed(0)} ms, with up to ${force.toFixed(0)} N`],
  result: (data) => ["result", pairs(data)],
  planning_unit: (data) => ["plan", `${data.name} ${data.what}${data.by ? ` by ${data.by}` : ""}`],
  unit_task: (data) => ["unit task", `${data.name} ${data.what}`],
  method: (data) => ["method", `${data.name} ${data.what}`],
  operator: (data) => ["operator", `${data.name} ${data.what}`],
  select: (data) => ["chosen", data.production],
  conflict: (data) => ["matching", Object.keys(data.utilities).join(", ") || "none"],
  buffer: (data) => ["holds", data.chunk ? chunkText(data.chunk) : "nothing"],
  retrieval: (data) => (data.failed ? ["fails", "nothing is retrieved"] : ["retrieved", data.chunk]),
  add: (data) => [data.merged ? "merges" : "adds", chunkText(data.chunk)],
  request: (data) => ["request", data.asked ?? pairs(data)],
  answer: (data) => ["answer", `${data.word}: ${valueText(data.value)}`],
  search: (data) => [data.bottom_up ? "notices" : "searches", `${data.asked}: ${data.noticed.length} noticed${data.why ? `, ${data.why}` : ""}`],
  sight: (data) => (data.failed ? ["sees", "nothing of that kind"] : ["sees", chunkText(data.chunk)]),
  move: (data) => ["moves", `${data.movement} (${data.group})`],
  moved: (data) => ["moved", `${data.movement} (${data.group}): ${data.end}`],
  refused: (data) => ["refused", `${data.movement}: ${data.why}`],
  utility: (data) => ["utility", `${data.production} ${data.part} ${valueText(data.value)}`],
};

/** Returns [what happened, its details] of an event; a firing is described by its production alone. */
export function eventText(event) {
  const [, , kind, data] = event;
  if (kind === "fire") return [data.production, pairs(data.bound)];
  return (TEXTS[kind] ?? ((all) => [kind, pairs(all)]))(data ?? {}, event);
}

/** Returns names with their values in one line. */
export function pairs(data) {
  return Object.entries(data ?? {})
    .map(([name, value]) => `${name}=${valueText(value)}`)
    .join("  ");
}

/** Returns a time of the run [us] as text in seconds. */
export function timeText(time) {
  return (time / 1e6).toFixed(3);
}
