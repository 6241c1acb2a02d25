// The command palette (Ctrl K): every command of the page, found by a few letters; what was used last comes first; and the manual.

import { command, permanent, present, readPresent, run } from "../commands.js";
import { KEY_GROUPS, keyText } from "../keys.js";
import { remembered } from "../local_storage.js";
import { html, signal, useEffect, useLayoutEffect, useRef } from "../vendor/preact.js";
import { match } from "./fuzzy.js";
import { hasManual, noManual } from "../bar/models.js";
import { showModal } from "../parts/dialog.js";
import "./experiments.js";
import { inManual, readManual } from "./manual_search.js";
import "./open_runs.js";
import "./recordings.js";

const MAX_RECENT = 6;
const MAX_ENTRIES = 60; // entries shown
const OWN = 4; // how much better it is if all words are in the text of a command, without its group
const WEAK = 0.6; // what fits worse than this share of the best is left out

const shown = signal(0); // which opening of the palette is shown; 0 if none
let openings = 0;
const search = signal("");
const chosen = signal(0);
/** Why the command that was taken last cannot be run; empty if it can. */
const refusal = signal("");
/** The names of the commands used last, the newest first. */
const recent = remembered("recent commands", []);

const nameOf = ({ group, text }) => `${group}: ${text}`;

/** Returns the text of an entry, with what its command would act on. */
const textOf = ({ text, about }) => [text, about?.()].filter(Boolean).join(": ");

/** Returns the entries for a search: {of, heading, places}. */
function found() {
  const words = search.value.trim();
  const all = [...permanent().filter((one) => one !== opening), ...present(words)];
  if (words === "") {
    const byName = new Map(all.map((one) => [nameOf(one), one]));
    const last = recent.value.flatMap((name) => byName.get(name) ?? []);
    const others = permanent().filter((one) => one !== opening && one.ready() && !last.includes(one));
    const groups = [...new Set([...KEY_GROUPS, "Tab", ...others.map(({ group }) => group)])];
    const ordered = groups.flatMap((group) => others.filter((one) => one.group === group));
    return [...last.map((of) => ({ of, heading: "Used last" })), ...ordered.map((of) => ({ of, heading: of.group }))];
  }
  const rank = (one) => {
    const place = recent.value.indexOf(nameOf(one));
    return place < 0 ? 0 : MAX_RECENT - place;
  };
  const hits = all
    .flatMap((of) => {
      const fits = [textOf(of), `${textOf(of)} ${of.group} ${of.also ?? ""}`].map((text) => match(words, text));
      if (fits[1] === null) return [];
      if (fits[0] !== null) fits[0].score += OWN;
      const best = fits.filter(Boolean).reduce((one, other) => (other.score > one.score ? other : one));
      return [{ of, heading: "Commands", places: best.places, score: best.score + rank(of) }];
    })
    .sort((one, other) => other.of.ready() - one.of.ready() || other.score - one.score);
  const best = Math.max(...hits.map(({ score }) => score));
  return hits.filter(({ score }) => score > WEAK * best).slice(0, MAX_ENTRIES);
}

/** Returns everything that is offered. */
function offered() {
  const pages = inManual(search.value.trim()).map((section) => ({
    of: { text: section.title, group: [section.page, section.text].filter(Boolean).join(": "), key: null, ready: () => true, work: () => open(section.address, "_blank", "noopener") },
    heading: "Manual",
  }));
  return [...found(), ...pages];
}

function take({ of, heading }) {
  refusal.value = of.ready() ? "" : `«${of.text}» is not possible now. ${of.why()}`;
  if (refusal.value) return;
  shown.value = 0;
  if (heading !== "Manual") recent.value = [nameOf(of), ...recent.newest().filter((name) => name !== nameOf(of))].slice(0, MAX_RECENT);
  setTimeout(() => run(of)); // after the palette has closed and given back the focus
}

function Text({ text, places }) {
  if (!places) return text;
  return Array.from(text, (letter, n) => (places.has(n) ? html`<b key=${n}>${letter}</b>` : letter));
}

function Entry({ entry, n }) {
  const { of, heading, places } = entry;
  const line = useRef(null);
  const isChosen = chosen.value === n;
  useLayoutEffect(() => {
    if (isChosen) line.current.scrollIntoView({ block: "nearest" });
  }, [isChosen]);
  return html`<li
    ref=${line}
    title=${of.ready() ? undefined : `Not possible now. ${of.why()}`}
    id="palette-${n}"
    role="option"
    aria-selected=${isChosen}
    aria-disabled=${!of.ready()}
    onPointerMove=${() => (chosen.value = n)}
    onClick=${() => take(entry)}
  >
    <span class="palette-text"><${Text} text=${textOf(of)} places=${places} /></span>
    ${heading === of.group ? null : html`<span class="palette-group quiet">${of.group}</span>`}
    ${of.key ? html`<kbd>${keyText(of.key)}</kbd>` : null}
  </li>`;
}

function Palette({ opening }) {
  const box = useRef(null);
  const entries = offered();
  const at = Math.min(chosen.value, entries.length - 1);
  useLayoutEffect(() => {
    const own = box.current;
    showModal(own);
    return () => own.close(); // which returns the focus
  }, []);
  useEffect(() => {
    readManual();
    readPresent();
  }, []);

  function press(event) {
    if (!box.current.open) return; // for a moment a closed dialog keeps the focus
    const to = { ArrowDown: at + 1, ArrowUp: at - 1, PageDown: Math.min(at + 8, entries.length - 1), PageUp: Math.max(at - 8, 0) }[event.key];
    if (to !== undefined && entries.length > 0) chosen.value = (to + entries.length) % entries.length;
    else if (event.key === "Enter" && entries[at]) take(entries[at]);
    else if (event.key.toLowerCase() === "k" && (event.ctrlKey || event.metaKey)) shown.value = 0;
    else return;
    event.preventDefault();
  }

  const title = hasManual.value ? "Search commands and the manual" : "Search commands";
  const groups = [...Map.groupBy(entries.map((entry, n) => ({ entry, n })), ({ entry }) => entry.heading)];
  // The event comes a moment after the dialog has closed; by then the palette may have been opened again.
  return html`<dialog class="palette" ref=${box} aria-label="Commands" onClose=${() => shown.value === opening && (shown.value = 0)} onClick=${(event) => event.target === box.current && (shown.value = 0)}>
    <input
      type="text"
      role="combobox"
      data-first
      spellcheck=${false}
      autocomplete="off"
      aria-label=${title}
      aria-expanded="true"
      aria-controls="palette-list"
      aria-activedescendant=${at >= 0 ? `palette-${at}` : undefined}
      placeholder=${title}
      value=${search.value}
      onInput=${(event) => ((search.value = event.currentTarget.value), (chosen.value = 0), (refusal.value = ""))}
      onKeyDown=${press}
    />
    <ul id="palette-list" role="listbox" aria-label="Found">
      ${groups.map(([heading, list], number) => html`<li key=${heading} role="presentation">
        <div class="palette-heading" role="presentation" id=${`palette-group-${number}`}>${heading}</div>
        <ul role="group" aria-labelledby=${`palette-group-${number}`}>${list.map(({ entry, n }) => html`<${Entry} key=${`${entry.of.group} ${entry.of.text}`} entry=${entry} n=${n} />`)}</ul>
      </li>`)}
    </ul>
    <p class="palette-refusal" role="status">${refusal.value}</p>
    ${entries.length === 0 ? html`<p class="empty">Nothing is found: try other words.</p>` : null}
    ${search.value.trim() && noManual.value ? html`<p class="palette-manual quiet">${noManual.value}</p>` : null}
  </dialog>`;
}

/** The command that opens it. */
export const opening = command({
  text: "All commands, and the manual",
  key: "Mod+k",
  group: "Page",
  work: () => {
    search.value = "";
    refusal.value = "";
    chosen.value = 0;
    shown.value = ++openings;
  },
});

/** The container of the palette. */
export function CommandPalette() {
  return shown.value ? html`<${Palette} key=${shown.value} opening=${shown.value} />` : null;
}
