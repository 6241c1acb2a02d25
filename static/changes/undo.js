// Undoes the last change by hand: the run goes back to its moment, and forgets it and what came after it.

import { sendChange } from "../bar/branch.js";
import { command } from "../commands.js";
import { runStatus } from "../run_status.js";
import { alive, events } from "../store.js";
import { commandText, isOfUser } from "../timeline/commands.js";
import { present } from "../timeline/seek.js";
import { changes } from "./changes.js";

/** Returns the event of the last change by hand up to the present moment; undefined if none is known. */
function latest() {
  const now = present.peek() * 1e6 + 0.5;
  return events.peek().list.findLast((event) => event[2] === "command" && event[0] <= now && isOfUser(event));
}

/** Whether there may be a change to undo: one that is known, or one that is no longer kept here. */
function canUndo() {
  return alive.value && changes.value.length > 0 && (latest() !== undefined || events.value.first > 0);
}

command({
  text: "Undo the last change by hand",
  about: () => (canUndo() && latest() ? commandText(latest()).join(" ") : ""),
  key: "Mod+z",
  group: "Run",
  work: () => sendChange({ type: "undo" }),
  ready: canUndo,
  why: () => (alive.value ? "Nothing was changed by hand up to now." : runStatus.value.text),
});
