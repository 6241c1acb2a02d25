// All productions: which match, which is chosen, where breakpoints are; one of them is explained.

import { html, useLayoutEffect, useRef, useState } from "../vendor/preact.js";
import { ChangeMenu } from "../changes/changes.js";
import { counted } from "../parts/count.js";
import { wordsOf } from "../parts/words.js";
import { productionKey, runOf, systemsOf } from "./agents.js";
import { at, production } from "./explanation.js";
import { breakpoints, held, toggleBreakpoint } from "./breakpoints.js";
import { buttonTitle } from "../keys.js";
import { chosenText, isBare, isGone, nothing } from "../run_status.js";
import { state } from "../store.js";

/** The status of a production: [class, sign, in words]. */
export function statusOf(reason) {
  if (!reason) return ["", "", ""];
  if (reason.matches === null) return ["unknown", "?", "unknown here"];
  if (reason.selected) {
    const text = chosenText(at.value === null);
    return ["selected", "▸", reason.matches ? `matches, and ${text}` : `${text}, though it no longer matches`];
  }
  return reason.matches ? ["matches", "✓", "matches"] : ["no", "–", "does not match"];
}

/** Returns the productions as [{system, name, reason}]; `reasons` are from the run's explanation. */
export function productionsOf(parts, reasons) {
  const gone = new Map(reasons.map((reason) => [productionKey(reason.system, reason.name), reason]));
  const found = systemsOf(parts).flatMap((system) =>
    parts[system].productions.map((name) => {
      const key = productionKey(system, name);
      const reason = gone.get(key) ?? null;
      gone.delete(key);
      return { system, name, reason };
    }),
  );
  return [...found, ...[...gone.values()].map((reason) => ({ system: reason.system, name: reason.name, reason }))];
}

const same = (one, other) => Boolean(one && other) && one.system === other.system && one.name === other.name;

/** Returns the production to explain: the requested one, else of a program's latest run the chosen one or the first that matches. */
export function explained(all) {
  const wanted = all.find((one) => same(one, production.value));
  const rank = ({ reason }) => (reason?.selected ? 0 : reason?.matches ? 1 : 2);
  return wanted ?? all.toSorted((one, other) => runOf(other.system) - runOf(one.system) || rank(one) - rank(other))[0] ?? null;
}

function isForbidden(system, name) {
  return state.value?.parts[system]?.forbidden?.includes(name) ?? false;
}

function Item({ item, chosen, several }) {
  const { system, name, reason } = item;
  const [kind, sign, words] = statusOf(reason);
  const marked = breakpoints.value.includes(name);
  const line = useRef(null);
  useLayoutEffect(() => {
    if (chosen) line.current.scrollIntoView({ block: "nearest" });
  }, [chosen]);
  return html`<li ref=${line} class="${kind} ${chosen ? "chosen" : ""} ${held.value === name ? "at" : ""}">
    <button class="dot" tabindex="-1" aria-pressed=${marked} aria-label="Breakpoint on ${name}" title=${buttonTitle({ key: "b" }, marked ? "Remove the breakpoint" : "Pause whenever it fires")} onClick=${() => toggleBreakpoint(name)}></button>
    <button class="name" tabindex=${chosen ? 0 : -1} aria-current=${chosen} title="${several ? `${system}: ` : ""}${name}${words ? `: ${words}` : ""}" onClick=${() => (production.value = { system, name })}>
      <span class="sign" role="img" aria-label=${words}>${sign}</span><span class="text">${name}</span>
      ${isForbidden(system, name) ? html`<span class="quiet" title="The user has forbidden it: it is left out of the next choice for which it matches">forbidden once</span>` : null}
    </button>
    <${ChangeMenu} of="production" given=${{ system, production: name }} label=${name} />
  </li>`;
}

/** @param all The result of `productionsOf`; `chosen` is the one that is explained. */
export function ProductionList({ all, chosen }) {
  const [words, setWords] = useState("");
  const box = useRef(null);
  const wanted = wordsOf(words);
  const shown = all.filter(({ system, name }) => wanted.every((word) => `${system} ${name}`.toLowerCase().includes(word)));
  const systems = [...new Set(shown.map(({ system }) => system))];
  const ordered = systems.flatMap((system) => shown.filter((one) => one.system === system));

  function press(event) {
    const at = ordered.findIndex((one) => same(one, chosen));
    const to = { ArrowUp: at - 1, ArrowDown: at + 1, Home: 0, End: ordered.length - 1 }[event.key];
    if (to !== undefined && ordered.length > 0) {
      const { system, name } = ordered[Math.max(0, Math.min(ordered.length - 1, to))];
      production.value = { system, name };
      if (event.target.tagName !== "INPUT") box.current.querySelectorAll("button.name")[ordered.findIndex((one) => one.system === system && one.name === name)].focus();
    } else if (event.key === "b" && event.target.classList.contains("name") && chosen) toggleBreakpoint(chosen.name);
    else return;
    event.preventDefault();
  }

  return html`<div class="production-list" onKeyDown=${press}>
    <input type="search" aria-label="Search productions" placeholder=${counted(all.length, "production")} value=${words} onInput=${(event) => setWords(event.currentTarget.value)} />
    <div class="production-names" ref=${box}>
      ${systems.map(
        (system) => html`<div key=${system}>
          ${systems.length > 1 || systemsOf(state.value?.parts).length > 1 ? html`<h3>${system}</h3>` : null}
          <ul aria-label="Productions of ${system}">
            ${shown.filter((one) => one.system === system).map((item) => html`<${Item} key=${item.name} item=${item} chosen=${same(item, chosen)} several=${systems.length > 1} />`)}
          </ul>
        </div>`,
      )}
      ${shown.length === 0 && !(isGone.value && isBare.value) ? html`<p class="empty">${all.length ? "No production of that name." : nothing("This model has no productions.")}</p>` : null}
    </div>
  </div>`;
}
