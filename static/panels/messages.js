// Messages to the user: errors with their lines, warnings, output of the model's process.

import { computed, html, useEffect } from "../vendor/preact.js";
import { command } from "../commands.js";
import { Button } from "../parts/button.js";
import { counted } from "../parts/count.js";
import { toggled } from "../parts/toggled.js";
import { Place, Traceback } from "../parts/place.js";
import { remembered } from "../local_storage.js";
import { goToTab } from "../open_tab.js";
import { isAhead, isPresent, isSettled, notices, settle, takeAction } from "../store.js";

const LEVELS = { error: "Errors", warning: "Warnings", info: "Other" };
const MAX_DRAWN = 300; // the maximum number drawn

const hidden = remembered("messages hidden", []);
/** The messages that the user has not cleared, also those after the moment that is shown. */
const uncleared = computed(() => notices.value.filter((notice) => !isSettled(notice, "cleared")));
/** Those of them up to the moment that is shown. */
const kept = computed(() => uncleared.value.filter((notice) => !isAhead(notice)));

/** The errors of the newest run since the tab was last open. */
function unseen() {
  return kept.value.filter((notice) => notice.level === "error" && isPresent(notice) && !isSettled(notice, "seen")).length;
}

function clear() {
  settle("cleared", kept.peek());
}

command({
  text: "Clear the messages",
  group: "Messages",
  work: () => {
    goToTab("messages"); // so that it is seen
    clear();
  },
  ready: () => kept.value.length > 0,
  why: () => "There are no messages.",
});

function Filter() {
  const count = (level) => kept.value.filter((notice) => notice.level === level).length;
  return html`<div class="tools" role="toolbar" aria-label="Messages">
    ${Object.entries(LEVELS).map(
      ([level, text]) => html`<label key=${level}>
        <input type="checkbox" checked=${!hidden.value.includes(level)} onChange=${() => (hidden.value = toggled(hidden.value, level))} />
        ${text} <span class="count">${count(level)}</span>
      </label>`,
    )}
    <span class="stretch"></span>
    <${Button} disabled=${kept.value.length === 0} title="Clear them on this page" onClick=${clear}>Clear<//>
  </div>`;
}

function Message({ notice }) {
  const { level, text, file, line, detail, action } = notice;
  return html`<li class=${`${level} ${isPresent(notice) ? "" : "earlier"}`}>
    ${file ? html`<${Place} file=${file} line=${line} />` : null}
    <span class="text">${text}</span>
    ${action ? html` <${Button} class="link action" onClick=${() => takeAction(notice)}>${action.text}<//>` : null}
    <${Traceback} message=${text} detail=${detail} />
  </li>`;
}

function Messages() {
  const all = kept.value;
  const ahead = uncleared.value.length - all.length;
  useEffect(() => settle("seen", all), [all]);
  const chosen = all.filter(({ level }) => !hidden.value.includes(level)).toReversed();
  const present = chosen.filter(isPresent);
  const list = [...present, ...chosen.filter((notice) => !isPresent(notice))];
  const none = all.length === 0 ? "No messages. Errors and warnings of the model appear here, with their lines." : "All messages are filtered out.";
  return html`<div class="messages">
    <${Filter} />
    ${ahead > 0 ? html`<p class="note" role="status">${counted(ahead, "message")} from after this moment ${ahead === 1 ? "is" : "are"} not shown.</p>` : null}
    ${list.length === 0 ? html`<p class="empty">${none}</p>` : null}
    <ol id="log" class="log" aria-live="polite" hidden=${list.length === 0}>
      ${list.slice(0, MAX_DRAWN).map(
        (notice, n) => html`${n === present.length ? html`<li key="earlier" class="heading">Earlier runs</li>` : null}<${Message} key=${notice.number} notice=${notice} />`,
      )}
    </ol>
    ${list.length > MAX_DRAWN ? html`<p class="empty">${list.length - MAX_DRAWN} older ones are not shown.</p>` : null}
  </div>`;
}

export const panel = {
  id: "messages",
  title: "Messages",
  order: 10,
  View: Messages,
  badge: () => (unseen() > 0 ? { text: unseen() > 99 ? "99+" : String(unseen()), level: "bad" } : null),
};
