// The chosen recordings, and the actions on them.

import { html } from "../vendor/preact.js";
import { Button } from "../parts/button.js";
import { useElapsed } from "../parts/elapsed.js";
import { Icon } from "../parts/icon.js";
import { buttonTitle } from "../keys.js";
import { remembered } from "../local_storage.js";
import { shownRecording } from "../store.js";
import { compareRuns } from "../compare/compare.js";
import { busy, cancelReplay, deleteRuns, openRun, replayRun, replays } from "./actions.js";
import { download, Downloads, filePath, formatsOf } from "./downloads.js";
import { labelRun } from "./label.js";
import { runs } from "./list.js";
import { endedText, isDifferent, labelOf, measureText, originText, outcomeText, settingsOf, whenInFull } from "./wording.js";

function DownloadLinks({ run }) {
  const get = (event, format, text) => (event.preventDefault(), download(run, format, text));
  return html`<span class="downloads">
    <${Icon} name="download" />
    ${formatsOf(run).map(([format, text, title]) => html`<a key=${format} href=${filePath(run, format)} download title=${title} onClick=${(event) => get(event, format, text)}>${text}</a>`)}
  </span>`;
}

const VERDICTS = {
  agrees: ["Every byte agrees.", "good"],
  "agrees up to its end": ["It agrees up to the end of the recording.", "good"],
  differs: ["It differs.", "bad"],
};

function Replayed({ run }) {
  const result = replays.value[run.id];
  const elapsed = useElapsed(result?.since);
  if (!result) return null;
  if (result.since) {
    return html`<div class="replayed" role="status">
      <progress aria-label="Running again" value=${result.share || undefined}></progress> running again … <span class="number">${result.share ? `${Math.floor(100 * result.share)} %, ` : ""}${elapsed}</span>
      <button class="bare" onClick=${() => cancelReplay(run.id)}>Cancel</button>
    </div>`;
  }
  if (result.verdict && result.events !== run.events) {
    return html`<div class="replayed" role="status">The recording has changed since it was replayed.</div>`;
  }
  const [head, kind] = VERDICTS[result.verdict] ?? ["Not known.", "bad"];
  return html`<div class="replayed" role="status"><b class=${kind}>${head}</b> <span>${result.text}</span></div>`;
}

/** Whether the facts about the chosen run are shown; where there is little room, the list has it at first. */
const withFacts = remembered("run facts", innerHeight >= 900);

function Facts({ run }) {
  const rows = [
    ["began", whenInFull(run.made)],
    ...(run.branched === null ? [] : [["branch", originText(run, runs.value)]]),
    ["end", endedText(run)],
    ["seed", String(run.seed)],
    ["events", run.events.toLocaleString("en")],
    ["file", run.id],
  ];
  const settings = settingsOf(run);
  return html`<div class="facts">
    <table aria-label="Result"><tbody>
      ${Object.entries(run.result ?? {}).map(([name, value]) => html`<tr key=${name}><th scope="row">${labelOf(name)}</th><td class="number">${measureText(name, value)}</td></tr>`)}
      ${rows.map(([name, value]) => html`<tr key=${name}><th scope="row">${name}</th><td>${value}</td></tr>`)}
    </tbody></table>
    <table aria-label="Parameters"><tbody>
      ${settings.length === 0 ? html`<tr><td class="empty">no parameters</td></tr>` : null}
      ${settings.map(([name, text]) => {
        const other = isDifferent(run, name);
        const why = !other ? "" : name in run.changed ? "Changed by hand during the run" : "Not the default";
        return html`<tr key=${name} class=${other ? "other" : ""}><th scope="row" title=${why}>${name}</th><td class="mono">${text}</td></tr>`;
      })}
    </tbody></table>
  </div>`;
}

function One({ run }) {
  const idle = busy.value !== null || Boolean(run.problem);
  const own = run.id === shownRecording.value;
  const noCompare = own ? "It is the present run" : shownRecording.value ? "Beside the present run" : "The present run is not recorded";
  return html`
    <div class="actions" role="toolbar" aria-label="The chosen run">
      <${Button} class="primary" disabled=${idle} title="Open this run again (double-click)" onClick=${() => openRun(run)}>Open<//>
      <${Button} disabled=${idle || Boolean(replays.value[run.id]?.since)} title="Run it again in a process of its own, and compare every byte" onClick=${() => replayRun(run)}>Replay<//>
      <${Button} disabled=${idle || own || !shownRecording.value} title=${noCompare} onClick=${() => compareRuns(run.id, shownRecording.value)}>Compare with the present run<//>
      <${Button} disabled=${Boolean(run.problem)} title="Give it a name, a note and tags; it is then never deleted automatically" onClick=${() => labelRun(run)}>Name …<//>
      <span class="stretch"></span>
      <${Button} class="danger bare" aria-label="Delete" title=${buttonTitle({ key: "Delete" }, "Delete")} disabled=${busy.value !== null} onClick=${() => deleteRuns([run])}><${Icon} name="trash" /><//>
    </div>
    <div class="files">
      <${DownloadLinks} run=${run} />
      ${run.problem ? null : html`<button class="bare" aria-expanded=${withFacts.value} title="Result, parameters, seed, events and file" onClick=${() => (withFacts.value = !withFacts.value)}>Details ${withFacts.value ? "▾" : "▸"}</button>`}
    </div>
    ${run.label?.note ? html`<p class="run-note">${run.label.note}</p>` : null}
    <${Replayed} run=${run} key=${run.id} />
    ${run.problem ? html`<p class="problem bad">This recording cannot be opened: ${run.problem}</p>` : withFacts.value ? html`<${Facts} run=${run} />` : null}
  `;
}

function Many({ list }) {
  const two = list.length === 2 && !list.some(({ problem }) => problem);
  return html`
    <div class="actions" role="toolbar" aria-label="The chosen runs">
      <b>${list.length} chosen</b>
      <${Button} class=${two ? "primary" : ""} disabled=${!two} title=${two ? "" : "Choose two that can be read"} onClick=${() => compareRuns(list[0].id, list[1].id)}>Compare<//>
      <span class="stretch"></span>
      <${Button} class="danger" disabled=${busy.value !== null} onClick=${() => deleteRuns(list)}><${Icon} name="trash" />Delete ${list.length}<//>
    </div>
    <ul class="many">${list.slice(0, 30).map((run) => html`<li key=${run.id}><span class="mono">${run.id}</span> ${outcomeText(run)}</li>`)}
      ${list.length > 30 ? html`<li class="quiet">and ${list.length - 30} more</li>` : null}
    </ul>
  `;
}

/** @param list The chosen recordings, in the order of the list. */
export function SelectedRuns({ list }) {
  const doing = busy.value;
  return html`<section class="runs-chosen ${withFacts.value ? "with-facts" : ""}" aria-label="Chosen">
    ${doing ? html`<div class="replayed" role="status"><progress value=${doing.done} max=${doing.of} aria-label=${doing.text}></progress> ${doing.text}${doing.of ? ` ${doing.done} of ${doing.of}` : ""}</div>` : null}
    <${Downloads} />
    ${list.length === 0 ? html`<p class="empty">Choose a run to open, replay or download it; two to compare them.</p>` : null}
    ${list.length === 1 ? html`<${One} run=${list[0]} />` : null}
    ${list.length > 1 ? html`<${Many} list=${list} />` : null}
  </section>`;
}
