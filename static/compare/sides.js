// The settings and results of two runs in two columns, and the difference of their models' texts.

import { html } from "../vendor/preact.js";
import { nameWithUnit, timeText } from "../parts/units.js";
import { remembered } from "../local_storage.js";
import { runs as recordings } from "../runs/list.js";
import { courseText, endedText, labelOf, measureText, originText, ownName, sizeText, whenText } from "../runs/wording.js";

const onlyOthers = remembered("compare only differences", false);

function namesOf(runs, part) {
  return [...new Set(runs.flatMap((run) => Object.keys(run[part] ?? {})))];
}

/** Returns rows of values of both runs: [name, one, other, whether they differ]. */
function rowsOf(runs, part, word, label = (name) => name) {
  return namesOf(runs, part).map((name) => {
    const values = runs.map((run) => (name in (run[part] ?? {}) ? run[part][name] : undefined));
    const [one, other] = values.map((value) => (value === undefined ? "–" : word(name, value)));
    return [label(name), one, other, JSON.stringify(values[0] ?? null) !== JSON.stringify(values[1] ?? null)];
  });
}

function Part({ title, rows, none }) {
  const shown = onlyOthers.value ? rows.filter(([, , , differs]) => differs) : rows;
  return html`<tbody>
    <tr class="part"><th colspan="3" scope="rowgroup">${title}</th></tr>
    ${shown.length === 0 ? html`<tr><td colspan="3" class="empty">${rows.length === 0 ? none : "no difference"}</td></tr>` : null}
    ${shown.map(
      ([name, one, other, differs]) => html`<tr key=${name} class=${differs ? "other" : ""}>
        <th scope="row">${differs ? html`<span class="unlike" title="They differ" aria-label="differs">≠</span>` : null}${name}</th>
        <td class="number">${one}</td><td class="number">${other}</td>
      </tr>`,
    )}
  </tbody>`;
}

/** Returns the initial value of a setting, and the values to which a user changed it during the run. */
function changesText(value, changes) {
  if (!changes?.length) return courseText(value);
  const [time, last] = changes.at(-1);
  const more = changes.length > 1 ? ` (changed ${changes.length} times)` : "";
  return `${courseText(value, last)} at ${timeText(time)}${more}`;
}

/** Returns the rows of the parameters, and of other values that were changed. */
function parameterRows(runs, changed, units) {
  const names = [...new Set([...namesOf(runs, "parameters"), ...changed.flatMap(Object.keys)])];
  return names.map((name) => {
    const [one, other] = runs.map((run, n) => changesText(run.parameters?.[name], changed[n][name]));
    return [nameWithUnit(name, units[name]), one, other, one !== other];
  });
}

/** @param runs Both runs, as the server describes them.
 * @param changed The users' changes during each run: [time, value], by name.
 * @param units The units of parameters and of other values that were changed, by name. */
export function SideBySide({ runs, changed, units }) {
  const [one, other] = runs;
  const line = (name, of) => [name, of(one), of(other), of(one) !== of(other)];
  const isOpen = runs.some(({ session }) => session); // then its file is larger than it will be
  const own = [
    line("model", (run) => run.model),
    line("seed", (run) => String(run.seed)),
    line("name", (run) => ownName(run) || "–"),
    line("began", (run) => whenText(run.made)),
    line("branch", (run) => originText(run, recordings.value)),
    line("end", endedText),
    line("simulated time", (run) => timeText(run.time)),
    line("events", (run) => run.events.toLocaleString("en")),
    ["size", ...runs.map(({ size }) => sizeText(size)), !isOpen && sizeText(one.size) !== sizeText(other.size)],
  ];
  return html`<table class="sides" aria-label="Side by side">
    <thead><tr>
      <th scope="col"><label><input type="checkbox" checked=${onlyOthers.value} onChange=${(event) => (onlyOthers.value = event.currentTarget.checked)} /> differences only</label></th>
      <th scope="col" class="number"><span class="dot first"></span>first</th><th scope="col" class="number"><span class="dot second"></span>second</th>
    </tr></thead>
    <${Part} title="Parameters" rows=${parameterRows(runs, changed, units)} none="neither has parameters" />
    <${Part} title="Results" rows=${rowsOf(runs, "result", measureText, labelOf)} none="nothing was measured of either" />
    <${Part} title="Runs" rows=${own} />
  </table>`;
}

const KINDS = { "-": "gone", "+": "come", "@": "place" };

/** @param lines The difference of the models' texts, as from `diff -u`. */
export function Changes({ lines }) {
  if (lines.length === 0) return null;
  const shown = lines.filter((line) => !line.startsWith("---") && !line.startsWith("+++"));
  return html`<section class="changes" aria-label="What differs in the model's text">
    <h3>The model's text differs</h3>
    <pre>${shown.map((line, n) => html`<span key=${n} class=${KINDS[line[0]] ?? ""}>${line}\n</span>`)}</pre>
  </section>`;
}
