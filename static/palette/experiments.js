// The experiments, and what can be done with them, as commands; they are listed when the palette is opened.

import { command, commandsOf } from "../commands.js";
import { canMakeReport, canResume, canStop, experiments, listExperiments, makeReport, resumeExperiment, showExperiment, stopExperiment } from "../experiments/list.js";
import { experimentText } from "../experiments/wording.js";
import { goToTab } from "../open_tab.js";

/** Shows an experiment; "new" for the form of a new one. */
function show(id) {
  goToTab("experiments");
  showExperiment(id);
}

command({ text: "New experiment …", group: "Run", work: () => show("new"), needs: "models folder" });

const ACTIONS = [
  ["Stop", canStop, stopExperiment],
  ["Resume", canResume, resumeExperiment],
  ["Make the report of", canMakeReport, makeReport],
];

commandsOf(
  () =>
    (experiments.value ?? []).flatMap((one) => {
      const name = experimentText(one);
      const actions = ACTIONS.filter(([, can]) => can(one)).map(([text, , work]) => ({ text: `${text} the experiment ${name}`, group: one.id, work: () => (show(one.id), work(one)) }));
      return [{ text: `Experiment: ${name}`, group: one.id, work: () => show(one.id) }, ...actions];
    }),
  { read: listExperiments, needs: "models folder" },
);
