// The recordings as commands; they are listed when the palette is first used.

import { commandsOf } from "../commands.js";
import { openRun } from "../runs/actions.js";
import { listRuns, runs } from "../runs/list.js";
import { nameOf } from "../runs/wording.js";

const MAX_RECORDINGS = 300; // the newest

/** Lists the recordings, if nothing else has done so. */
export function readRecordings() {
  if (runs.peek() === null) listRuns();
}

commandsOf(() => (runs.value ?? []).slice(0, MAX_RECORDINGS).map((run) => ({ text: `Recording: ${nameOf(run)}`, group: run.id, work: () => openRun(run), ready: () => !run.problem })));
