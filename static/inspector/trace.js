// The firing trace: the events, line by line, filtered as the user chooses.

import { html, useMemo, useState } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { agentsOf, isBelow, nameIn, systemsOf } from "./agents.js";
import { eventMomentText, eventText, eventTimeText, GROUPS, isInGroups } from "./event_text.js";
import { Rows } from "./rows.js";
import { useEventFilter } from "./event_filter.js";
import { askWhy } from "./explanation.js";
import { Mixed, contactEvents } from "./contacts.js";
import { Menu } from "../parts/menu.js";
import { toggled } from "../parts/toggled.js";
import { timeUnit } from "../parts/units.js";
import { wordsOf } from "../parts/words.js";
import { furthest, seek, travel } from "../timeline/seek.js";
import { nothingYet, runStatus } from "../run_status.js";
import { fetching } from "../earlier_events.js";
import { buttonTitle } from "../keys.js";
import { eventCount, events, session, shownRun, state } from "../store.js";
import { remembered } from "../local_storage.js";

const USUAL = GROUPS.filter(({ first }) => first).map(({ id }) => id);
const groups = remembered("trace groups", USUAL);
/** The width of the column of times: enough for a day. */
const timeWidth = () => (timeUnit(furthest.value) ? "88px" : "112px");
const wantedWords = remembered("trace words", "");

function testOf(isShown, words, agent) {
  const wanted = wordsOf(words);
  return (event) => {
    if (!isShown(event[2])) return false;
    if (agent && event[1] !== agent && !isBelow(event[1], agent)) return false;
    if (wanted.length === 0) return true;
    const text = `${event[1]} ${event[2]} ${eventText(event).join(" ")}`.toLowerCase();
    return wanted.every((word) => text.includes(word));
  };
}

function Groups() {
  const all = GROUPS.map(({ id }) => id);
  return html`<${Menu} class="events-menu" label="Events that are shown" name=${null} look="" face=${html`Events <span class="quiet">${groups.value.length}/${all.length}</span>`}>
    ${() => html`${GROUPS.map(
        ({ id, text }) => html`<label key=${id}><input type="checkbox" checked=${groups.value.includes(id)} onChange=${() => (groups.value = toggled(groups.value, id))} />${text}</label>`,
      )}
      <div class="menu-end">
        <button onClick=${() => (groups.value = all)}>All</button>
        <button onClick=${() => (groups.value = USUAL)}>Defaults</button>
      </div>`}
  <//>`;
}

/** Takes the run to its first stop after an event, or to a contact, which has a negative number. */
function goTo(number, [time]) {
  if (number < 0) return seek(time / 1e6);
  const { kind, period } = session.peek();
  const tick = kind === "program" ? 1 : Math.round(period * 1e6);
  return travel((Math.ceil(time / tick) * tick) / 1e6);
}

function Row({ number, event, ahead, chosen, several, onChoose, attributes }) {
  const [time, source, kind] = event;
  const [what, more] = eventText(event);
  const go = () => (onChoose(), goTo(number, event));
  return html`<tr
    class="${kind} ${ahead ? "ahead" : ""} ${chosen ? "chosen" : ""}"
    ...${attributes}
    title="${eventMomentText(time)}  ${source}  ${what}  ${more}${ahead ? "\nafter the present moment" : ""}\nClick: go to this moment"
    onClick=${go}
  >
    <td class="number time">${eventTimeText(time)}</td>
    ${several ? html`<td class="source">${source}</td>` : null}
    <td class="what"><b>${what}</b><span>${more}</span></td>
    <td class="ask">
      ${number >= 0 && (kind === "fire" || chosen)
        ? html`<button class="bare" tabindex="-1" title=${buttonTitle({ key: "w" }, "Why? Explains this moment, and leaves the run where it is")} aria-label="Why at ${eventMomentText(time)}" onClick=${(press) => (press.stopPropagation(), onChoose(), askWhy(number))}>why</button>`
        : null}
    </td>
  </tr>`;
}

export function FiringTrace() {
  const parts = state.value?.parts;
  const [agent, setAgent] = useState("");
  const run = shownRun.value;
  const [choice, setChoice] = useState({ run, number: null });
  const chosen = choice.run === run ? choice.number : null;
  const setChosen = (number) => setChoice({ run, number });
  const systems = systemsOf(parts);
  const wanted = systems.includes(agent) ? agent : "";
  const key = `${groups.value} ${wantedWords.value} ${wanted}`;
  const isShown = useMemo(() => isInGroups(groups.value), [groups.value]);
  const test = testOf(isShown, wantedWords.value, wanted);
  const filtered = useEventFilter(test, key);
  const mixed = new Mixed(filtered.numbers, contactEvents().filter(test));
  const { first, list } = events.value;
  const now = eventCount.value;
  const time = (state.value?.time ?? 0) * 1e6 + 1;
  const present = filtered.below(now) + mixed.contacts.filter(([begins]) => begins <= time).length;
  const several = systems.length > 1;
  const at = chosen === null ? -1 : filtered.below(chosen);
  const chosenRow = chosen < 0 ? (mixed.rowOfContact(chosen) ?? null) : filtered.numbers[at] === chosen && chosen !== null ? mixed.rowOf(at) : null;

  const row = (n, attributes) => {
    const number = mixed.numberAt(n);
    const event = mixed.at(number);
    return html`<${Row} key=${number} number=${number} event=${event} ahead=${number < 0 ? event[0] > time : number >= now} chosen=${number === chosen} several=${several} onChoose=${() => setChosen(number)} attributes=${attributes} />`;
  };
  const open = (n) => goTo(mixed.numberAt(n), mixed.at(mixed.numberAt(n)));
  const nothing = list.length === 0 || (runStatus.value.is === "ready" && wantedWords.value === "") ? nothingYet() : "All events are filtered out.";
  return html`<section class="trace">
    <div class="tools">
      <input type="search" aria-label="Filter the trace" placeholder="Filter" value=${wantedWords.value} onInput=${(event) => (wantedWords.value = event.currentTarget.value)} />
      ${several
        ? html`<select aria-label="Agent of the trace" value=${wanted} onChange=${(event) => setAgent(event.currentTarget.value)}>
            <option value="">${agentsOf(parts).length > 1 ? "all agents" : "all systems"}</option>
            ${systems.map((path) => html`<option key=${path} value=${path}>${nameIn("", path)}</option>`)}
          </select>`
        : null}
      <${Groups} />
    </div>
    ${first > 0 ? html`<p class="gap-note" role="note">${counted(first, "earlier event is", "earlier events are")} ${fetching.value ? "being fetched …" : "not shown"}</p>` : null}
    <${Rows}
      id="events"
      label="Firing trace"
      count=${mixed.count}
      row=${row}
      columns=${several ? [timeWidth(), "22%", "auto", "42px"] : [timeWidth(), "auto", "42px"]}
      head=${html`<th class="number">Time${timeUnit(furthest.value)}</th>${several ? html`<th>Agent</th>` : null}<th>Event</th><th><span class="unseen">Why</span></th>`}
      aim=${present > 0 ? present - 1 : null}
      chosen=${chosenRow}
      onChoose=${(n) => setChosen(mixed.numberAt(n))}
      onOpen=${open}
      keys=${{ w: (n) => mixed.numberAt(n) >= 0 && askWhy(mixed.numberAt(n)) }}
      empty=${html`<p class="empty">${nothing}</p>`}
    />
  </section>`;
}
