// The first event at which the traces of two runs differ, with the events before and after it.

import { html, useLayoutEffect, useRef } from "../vendor/preact.js";
import { chunkText, valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { commandText } from "../timeline/commands.js";

const KINDS = [
  ["all events", []],
  ["firings", ["fire"]],
  ["firings and requests", ["fire", "request"]],
  ["commands to the body", ["request", "move", "moved", "answer"]],
  ["what the eye sees", ["search", "sight"]],
  ["output", ["output"]],
];

const isCommand = (event) => event?.[2] === "command";

/** Returns the data of an event as text; a command as the timeline shows it. */
function dataText(event) {
  return isCommand(event) ? commandText(event).join(" ") : chunkText(event[3]);
}

/** Returns what differs between two events, as [name, one, other]. */
function differing({ what, events }) {
  const rows = what.map(([name, one, other]) => [name, valueText(one), valueText(other)]);
  if (!events.every(isCommand)) return rows;
  const [[name, one], [otherName, other]] = events.map((event) => commandText(event));
  if (name === otherName && one === other) return rows;
  const command = name === otherName ? [name, one, other] : ["command", `${name} ${one}`, `${otherName} ${other}`];
  return [...rows.filter(([part]) => ["time", "source"].includes(part)), command];
}

function Cells({ event, none }) {
  if (!event) return html`<td colspan="4" class="empty">${none}</td>`;
  const [time, source, kind] = event;
  const text = dataText(event);
  return html`
    <td class="number">${(time / 1e6).toFixed(3)}</td><td class="mono" title=${source}>${source}</td><td>${kind}</td>
    <td class="mono particulars" title=${text}>${text}</td>
  `;
}

function headline({ same_events: same, whole, difference }) {
  const count = counted(same, "event");
  const first = same === 1 ? "The first event is" : `The first ${count} are`;
  if (!difference) return whole ? `The traces are the same: ${count}.` : `${first} the same; no more are compared.`;
  const [one, other] = difference.events;
  if (!one || !other) return `${first} the same; then the ${one ? "second" : "first"} run has no more.`;
  if (same === 0) return `The traces differ from the first event on, at ${difference.time.toFixed(3)} s.`;
  return `${first} the same; the traces part at ${difference.time.toFixed(3)} s.`;
}

function What({ difference }) {
  const what = differing(difference);
  if (what.length === 0) return null;
  return html`<ul class="what" aria-label="What differs">
    ${what.map(([name, one, other]) => html`<li key=${name}><b>${name}</b> <span class="mono"><span class="dot first"></span>${one}</span> <span class="mono"><span class="dot second"></span>${other}</span></li>`)}
  </ul>`;
}

function Rows({ difference }) {
  const { before, events, after } = difference;
  const rest = Array.from({ length: Math.max(after[0].length, after[1].length) }, (_, n) => [after[0][n], after[1][n]]);
  const over = "no more events";
  const box = useRef(null);
  // The first difference is in sight, also in a smaller window.
  useLayoutEffect(() => {
    const show = () => {
      const here = box.current.querySelector(".here");
      box.current.scrollTop = here.offsetTop - (box.current.clientHeight - here.offsetHeight) / 2;
    };
    show();
    const watch = new ResizeObserver(() => box.current && show());
    watch.observe(box.current);
    return () => watch.disconnect();
  }, [difference]);
  return html`<div class="parting" ref=${box} tabindex="0" role="region" aria-label="Events side by side"><table aria-label="Events around the first difference">
    <thead><tr>${["first", "second"].map((side) => html`<th class="number" scope="col"><span class="dot ${side}"></span>time</th><th scope="col">source</th><th scope="col">kind</th><th scope="col">data</th>`)}</tr></thead>
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
