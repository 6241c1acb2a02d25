// The recordings, and what can be done with that of the present run, as commands; they are listed when the palette is opened.

import { commandsOf } from "../commands.js";
import { compareRuns } from "../compare/compare.js";
import { goToTab } from "../open_tab.js";
import { deleteRuns, openRun, replayRun } from "../runs/actions.js";
import { download, formatsOf } from "../runs/downloads.js";
import { labelRun } from "../runs/label.js";
import { listRuns, runs } from "../runs/list.js";
import { chosen } from "../runs/table.js";
import { nameOf } from "../runs/wording.js";
import { shownRecording } from "../store.js";

const MAX_RECORDINGS = 300; // the newest

/** Returns the recording of the present run; undefined if it is not listed. */
const presentRun = () => runs.value?.find(({ id }) => id === shownRecording.value);

/** Lists the recordings, unless they and the present run are listed. */
function read() {
  if (runs.peek() === null || (shownRecording.peek() !== null && !presentRun())) listRuns();
}

commandsOf(
  () => (runs.value ?? []).slice(0, MAX_RECORDINGS).map((run) => ({ text: `Recording: ${nameOf(run)}`, group: run.id, work: () => openRun(run), ready: () => !run.problem, why: () => run.problem })),
  { read, needs: "models folder" },
);

/** Shows a run in the list, where the progress of its action is shown, too. */
function show({ id }) {
  goToTab("runs");
  chosen.value = new Set([id]);
}

commandsOf(
  () => {
    const run = presentRun();
    if (!run) return [];
    const of = (text, work, more = {}) => ({ text: `${text} the present run`, group: "Runs", work, ...more });
    const others = [...chosen.value].filter((id) => id !== run.id);
    return [
      of("Name (name, note, tags)", () => labelRun(run)),
      of("Replay", () => (show(run), replayRun(run))),
      of("Compare the chosen recording with", () => compareRuns(others[0], run.id), { ready: () => others.length === 1, why: () => "Choose one other recording in the tab Runs." }),
      ...formatsOf(run).map(([format, text]) => of(`Download ${text} of`, () => (show(run), download(run, format, text)))),
      of("Delete", () => deleteRuns([run])),
    ];
  },
  { needs: "models folder" },
);
