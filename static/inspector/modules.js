// The modules of an agent: whether they are busy or in error, what they wait for, and all their plain attributes.

import { html } from "../vendor/preact.js";
import { requestText, valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { chosenText } from "../run_status.js";
import { eventCount } from "../store.js";
import { eventMomentText, pairs } from "./event_text.js";
import { Flash } from "./flash.js";
import { eventAt, useEventFilter } from "./event_filter.js";

/** Returns the newest request to each part up to the current moment, by path. */
export function useRequests(paths) {
  const filtered = useEventFilter((event) => event[2] === "request", "requests");
  const found = new Map();
  const wanted = new Set(paths);
  for (let n = filtered.below(eventCount.value) - 1; n >= 0 && wanted.size > 0; n -= 1) {
    const event = eventAt(filtered.numbers[n]);
    if (wanted.delete(event[1])) found.set(event[1], event);
  }
  return found;
}

function waitingText([time, , , data]) {
  const { call, asked, ...rest } = data;
  const given = Object.fromEntries(Object.entries(rest).filter(([, value]) => value !== null && typeof value !== "object"));
  return `${asked !== undefined ? `'${requestText(asked)}'` : `${call ?? "request"} ${pairs(given)}`}, asked at ${eventMomentText(time)}`;
}

/** Returns the status of a part: what it waits for, which production is about to fire, how many chunks it has. */
function doing(part, request) {
  if (part.is === "system") return part.chosen ? `${part.chosen} ${chosenText()}` : "nothing matches";
  if (part.state?.busy === true) {
    const groups = Object.keys(part.state).filter((name) => name.endsWith("_busy") && part.state[name] === true);
    if (groups.length) return `moves ${groups.map((name) => name.slice(0, -5).replaceAll("_", " ")).join(", ")}`;
    return request ? `waits for ${waitingText(request)}` : "waits for an answer";
  }
  if (part.state?.watching === true) return "watches";
  if (part.is === "memory") return counted(part.state.size ?? 0, "chunk");
  return "";
}

/** The plain attributes of a part. */
function Attributes({ path, part }) {
  const rows = Object.entries(part.state ?? {});
  if (rows.length === 0) return html`<p class="empty">It has no plain attributes.</p>`;
  return html`<table class="attributes" aria-label="Attributes of ${path}">
    <tbody>
      ${rows.map(([name, value]) => html`<tr key=${name}><th scope="row">${name}</th><td class="mono"><${Flash} text=${valueText(value)} /></td></tr>`)}
    </tbody>
  </table>`;
}

function Lamp({ name, on, level }) {
  return html`<span class="lamp ${on ? level : "off"}" aria-label="${on ? "" : "not "}${name}" role="img">${name}</span>`;
}

/** A module, memory or production system: a row that can be expanded. */
export function Module({ path, name, part, request }) {
  const { busy, error } = part.state ?? {};
  const text = doing(part, request);
  return html`<details class="part" data-path=${path}>
    <summary>
      <span class="name mono" title=${path}>${name}</span>
      <span class="kind quiet">${part.class}</span>
      <span class="lamps">
        ${typeof busy === "boolean" ? html`<${Lamp} name="busy" on=${busy} level="on" />` : null}
        ${typeof error === "boolean" ? html`<${Lamp} name="error" on=${error} level="wrong" />` : null}
      </span>
      <span class="doing" title=${text}><${Flash} text=${text} /></span>
    </summary>
    <${Attributes} path=${path} part=${part} />
  </details>`;
}

/** A part that is neither a buffer nor a module: its attributes in a line, and below it when expanded. */
export function Plain({ path, name, part }) {
  const text = pairs(part.state);
  return html`<details class="part" data-path=${path}>
    <summary>
      <span class="name mono" title=${path}>${name}</span>
      <span class="kind quiet">${part.class}</span>
      <span class="doing mono" title=${text}>${text}</span>
    </summary>
    <${Attributes} path=${path} part=${part} />
  </details>`;
}
