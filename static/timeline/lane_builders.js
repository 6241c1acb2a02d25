// The effect of each kind of event (`actr3d/trace_kinds.py`) on the lanes.

import { requestText, valueText } from "../parts/chunk.js";
import { commandText } from "./commands.js";

const LEVELS = { planning_unit: "planning unit", unit_task: "unit task", method: "method", operator: "operator" };
const BEGINS = new Set(["begun", "resumed", "going on"]);

/** Returns the part of a path before the last dot. */
function owner(path) {
  return path.includes(".") ? path.slice(0, path.lastIndexOf(".")) : "";
}

function level(kind) {
  return (lanes, time, source, { name, what, path, by }) => {
    // All four rows of an agent exist from the start, in their order.
    for (const [one, label] of Object.entries(LEVELS)) lanes.lane(`${one} ${owner(source)}`, "plan", [owner(source), label].filter(Boolean).join("."));
    const lane = lanes.lane(`${kind} ${owner(source)}`, "plan");
    if (BEGINS.has(what)) lane.begin(time, { text: name, tone: lanes.tone(name), more: path });
    else lane.close(time, what === "ended" ? "" : `${what}${by ? ` by ${by}` : ""}`);
  };
}

function productions(lanes, source) {
  return lanes.lane(`productions ${source}`, "productions", source);
}

/** Returns a band of a production: its curves are about the same subject. */
function ofProduction(lanes, source, production, more) {
  return { text: production, tone: lanes.tone(production), subject: source === "top" ? production : `${source}.${production}`, more };
}

function select(lanes, time, source, { production }) {
  productions(lanes, source).begin(time, ofProduction(lanes, source, production, "chosen, fires at the end"));
}

function fire(lanes, time, source, { production, bound }) {
  const lane = productions(lanes, source);
  const names = Object.entries(bound ?? {}).map(([name, value]) => `${name}: ${valueText(value)}`);
  const more = names.length ? `bound ${names.join(", ")}` : "";
  const open = lane.open;
  if (open?.text === production && open.from < time) {
    open.more = more;
    lane.close(time, "fired");
  } else {
    if (open) lane.close(time);
    lane.mark(time, { ...ofProduction(lanes, source, production, more || "fired"), tick: true });
  }
}

function changed(lanes, time, source) {
  const lane = productions(lanes, source);
  if (lane.open) Object.assign(lane.open, { tone: "quiet", subject: null, more: "" });
  lane.close(time, "no longer matched, did not fire");
}

function buffer(lanes, time, source, { chunk }) {
  lanes.former.hold(source, chunk);
  const lane = lanes.lane(`buffer ${source}`, "buffers", source);
  if (chunk) lane.begin(time, { chunk, tone: "series-3" });
  else lane.close(time);
}

/** Returns the latest request to a module in a few words. */
function request(lanes, time, source, data) {
  const text = requestText(valueText(data.asked ?? data.movement ?? data.word ?? data.pattern ?? data.call ?? ""));
  lanes.asked.set(source, { time, text });
  const open = lanes.lanes.get(`module ${source}`)?.open;
  if (open && open.from === time && !open.bad) open.text = text;
}

function state(lanes, time, source, data) {
  if (!("busy" in data || "error" in data)) return;
  const lane = lanes.lane(`module ${source}`, "modules", source);
  lane.is = { ...lane.is, ...data };
  const asked = lanes.asked.get(source);
  const text = asked && asked.time === time ? asked.text : "busy";
  const open = lane.open;
  if (lane.is.error) {
    if (open?.bad) return;
    if (open) open.tone = "bad";
    lane.close(time, "failed");
    lane.begin(time, { text: "error", tone: "bad", bad: true });
  } else if (lane.is.busy) {
    if (!open || open.bad) lane.begin(time, { text, tone: "series-2" });
  } else lane.close(time);
}

function limb(lanes, source, group) {
  return lanes.lane(`limb ${source} ${group}`, "modules", `${source} ${group}`);
}

function move(lanes, time, source, { movement, group, to }) {
  const aims = Object.entries(to ?? {}).map(([joint, value]) => `${joint} to ${((value * 180) / Math.PI).toFixed(1)} deg`);
  limb(lanes, source, group).begin(time, { text: movement, tone: "series-5", more: group === "legs" ? "" : aims.join(", ") });
}

function moved(lanes, time, source, { group, end }) {
  const lane = limb(lanes, source, group);
  if (lane.open && end === "blocked") lane.open.tone = "bad";
  lane.close(time, end);
}

function refused(lanes, time, source, { movement, group, why }) {
  const lane = lanes.lane(`refusals ${source}`, "modules", `${source} refused`);
  lane.mark(time, { text: `${movement}: ${why}`, tone: "bad", more: group ?? "" });
}

/** Creates the rows that exist before they have contents, so that others do not move. */
function start(lanes) {
  lanes.lane("said", "marks", "printed");
}

function output(lanes, time, _source, { text }) {
  lanes.lane("said", "marks", "printed").mark(time, { text: String(text), tone: "text" });
}

/** All changes of one moment are one mark, which lists each of them: `undo` takes back the last one. */
function command(lanes, time, _source, _data, event) {
  lanes.former.take(event);
  const lane = lanes.lane("commands", "marks", "commands");
  const earlier = lane.bands.at(-1)?.from === time ? [lane.bands.pop().text] : [];
  lane.mark(time, { text: [...earlier, commandText(event).join(" ")].join("; "), tone: "accent" });
}

function reward(lanes, time, source, { value }) {
  lanes.lane("rewards", "marks", "rewards").mark(time, { text: `${valueText(value)} to ${source}`, tone: "good" });
}

function utility(lanes) {
  lanes.learns = true;
}

/** What a part holds or does ends on the axis with its run: a program may make other runs afterwards. */
function stop(lanes, time, source) {
  for (const lane of lanes.ofRun(source)) lane.suspend(time);
}

function run(lanes, time, source) {
  for (const lane of lanes.ofRun(source)) lane.resume(time);
}

/** By the kind of the event: the function that adds it to the lanes, at a time of the axis [s]. */
export const TAKERS = {
  ...Object.fromEntries(Object.keys(LEVELS).map((kind) => [kind, level(kind)])),
  select,
  fire,
  changed,
  withdrawn: changed,
  buffer,
  request,
  state,
  move,
  moved,
  refused,
  start,
  run,
  stop,
  output,
  command,
  reward,
  utility,
};
