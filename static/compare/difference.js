// The first event at which the traces of two runs differ, with the events before and after it.

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { eventText, eventTimeText, eventValues } from "../inspector/event_text.js";
import { valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { useSize } from "../parts/size.js";
import { timeText } from "../parts/units.js";
import { GROUPS } from "../trace_kinds.js";

const KINDS = [["all events", []], ...GROUPS.filter(({ kinds }) => kinds.length > 0).map(({ text, kinds }) => [text, kinds])];

const MOST = 8; // the number of different values that are shown

const isNested = (value) => typeof value === "object" && value !== null && !Array.isArray(value);
const exactText = (value) => (typeof value === "string" ? value : JSON.stringify(value));

/** Returns the values that differ, as [name, one, other]; inside values that have named parts, these parts. */
function unequal(one, other) {
  return [...new Set([...Object.keys(one), ...Object.keys(other)])].flatMap((name) => {
    const values = [one, other].map((all) => (Object.hasOwn(all, name) ? all[name] : undefined));
    if (JSON.stringify(values[0]) === JSON.stringify(values[1])) return [];
    if (values.every(isNested)) return unequal(...values).map(([part, ...both]) => [`${name} ${part}`, ...both]);
    const texts = values.map((value) => (value === undefined ? "–" : valueText(value)));
    return [[name, ...(texts[0] === texts[1] ? values.map(exactText) : texts)]];
  });
}

/** Returns what differs between two events in words, as [name, one, other]. */
export function differing([one, other]) {
  const [mine, its] = [one, other].map(([time, source]) => ({ "time [s]": time / 1e6, source }));
  const [[what, text], [otherWhat, otherText]] = [eventText(one), eventText(other)];
  const rows = unequal(mine, its);
  if (one[2] !== other[2] || what !== otherWhat) return [...rows, ["event", `${what} ${text}`.trim(), `${otherWhat} ${otherText}`.trim()]];
  const [values, others] = [eventValues(one), eventValues(other)];
  const named = Object.keys(values).some((name) => Object.hasOwn(others, name)) ? unequal(values, others) : [];
  if (named.length > 0) return [...rows, ...named];
  return [...rows, ...(text === otherText ? unequal(one[3] ?? {}, other[3] ?? {}) : [[what, text, otherText]])];
}

function Cells({ event, none }) {
  if (!event) return html`<td colspan="3" class="empty">${none}</td>`;
  const [time, source] = event;
  const [what, text] = eventText(event);
  return html`
    <td class="number">${eventTimeText(time, time / 1e6)}</td><td class="mono" title=${source}>${source}</td>
    <td class="event" title="${what} ${text}"><b>${what}</b> ${text}</td>
  `;
}

function headline({ same_events: same, whole, difference }) {
  const count = counted(same, "event");
  const first = same === 1 ? "The first event is" : `The first ${count} are`;
  if (!difference) return whole ? `The traces are the same: ${count}.` : `${first} the same; no more are compared.`;
  const [one, other] = difference.events;
  if (same === 0 && (!one || !other)) return `Only the ${one ? "first" : "second"} run has such events.`;
  if (!one || !other) return `${first} the same; then the ${one ? "second" : "first"} run has no more.`;
  if (same === 0) return `The traces differ from the first event on, at ${timeText(difference.time, 3)}.`;
  return `${first} the same; the traces first differ at ${timeText(difference.time, 3)}.`;
}

function What({ difference }) {
  const what = difference.events.includes(null) ? [] : differing(difference.events);
  if (what.length === 0) return null;
  return html`<ul class="what" aria-label="What differs">
    ${what.slice(0, MOST).map(([name, one, other]) => html`<li key=${name}><b>${name}</b> <span class="mono" title=${one}><span class="dot first"></span>${one}</span> <span class="mono" title=${other}><span class="dot second"></span>${other}</span></li>`)}
    ${what.length > MOST ? html`<li class="quiet">and ${what.length - MOST} more</li>` : null}
  </ul>`;
}

function Rows({ difference }) {
  const { before, events, after } = difference;
  const rest = Array.from({ length: Math.max(after[0].length, after[1].length) }, (_, n) => [after[0][n], after[1][n]]);
  const over = "no more events";
  const box = useRef(null);
  const { height } = useSize(box);
  // The first difference is in sight, also in a smaller window.
  useLayoutEffect(() => {
    const here = box.current.querySelector(".here");
    box.current.scrollTop = here.offsetTop - (box.current.clientHeight - here.offsetHeight) / 2;
  }, [difference, height]);
  return html`<div class="parting" ref=${box} tabindex="0" role="region" aria-label="Events side by side"><table aria-label="Events around the first difference">
    <thead><tr>${["first", "second"].map((side) => html`<th class="number" scope="col"><span class="dot ${side}"></span>time</th><th scope="col">source</th><th scope="col">event</th>`)}</tr></thead>
    <tbody>
      ${before.map((event, n) => html`<tr key="b${n}" class="same"><${Cells} event=${event} /><${Cells} event=${event} /></tr>`)}
      <tr class="here"><${Cells} event=${events[0]} none=${over} /><${Cells} event=${events[1]} none=${over} /></tr>
      ${rest.map(([one, other], n) => html`<tr key="a${n}"><${Cells} event=${one} none="" /><${Cells} event=${other} none="" /></tr>`)}
    </tbody>
  </table></div>`;
}

/**
 * @param answer The response of `POST /api/compare`.
 * @param kinds A signal with the kinds of events to compare; empty for all.
 */
export function Difference({ answer, waiting, kinds }) {
  const { difference } = answer;
  const chosen = Math.max(0, KINDS.findIndex(([, list]) => list.join() === kinds.value.join()));
  return html`<section class="difference" aria-label="First difference">
    <header>
      <h3>Traces</h3>
      <select aria-label="Which events are compared" value=${String(chosen)} onChange=${(event) => (kinds.value = KINDS[event.currentTarget.value][1])}>
        ${KINDS.map(([text], n) => html`<option key=${n} value=${String(n)}>${text}</option>`)}
      </select>
      <p role="status" class="headline">${waiting ? html`<progress aria-label="Comparing"></progress> ` : null}${headline(answer)}</p>
    </header>
    ${difference ? html`<${What} difference=${difference} /><${Rows} difference=${difference} />` : null}
  </section>`;
}
