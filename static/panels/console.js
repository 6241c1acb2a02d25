// The model's output, line by line, with the warnings and errors of the run between its lines; goes back with the run.

import { computed, html, signal, useEffect, useLayoutEffect, useMemo, useRef } from "../vendor/preact.js";
import { command } from "../commands.js";
import { clear, fillGaps, printed, printedVersion } from "../inspector/printed.js";
import { Button } from "../parts/button.js";
import { CopyButton, copyText } from "../parts/copy.js";
import { counted } from "../parts/count.js";
import { Icon } from "../parts/icon.js";
import { Lines } from "../parts/lines.js";
import { pictureName, saveFile } from "../parts/picture.js";
import { Place } from "../parts/place.js";
import { useSize } from "../parts/size.js";
import { widthOf } from "../parts/surface.js";
import { goToTab } from "../open_tab.js";
import { nothingYet, runStatus } from "../run_status.js";
import { alive, eventCount, isGiven, moment, notices, session, shownRun, state } from "../store.js";
import { firstWhere } from "../parts/search.js";
import { inThePast } from "../timeline/seek.js";

const SIDES = 40; // the room for the margins of a row and for a scroll bar [px]
const LONGEST = 2000; // the number of characters of a line that are drawn
/** What is searched, and in which run: another run is shown as a whole at first. */
const search = signal({ of: "", words: "" });
const words = computed(() => (search.value.of === shownRun.value ? search.value.words : ""));
/** The number of characters that the panel has room for in a row. */
const columns = signal(80);

/** Control characters for terminals, and those that change the direction of text: shown as signs, without effect. */
const CONTROL = /\u001b\[[0-?]*[ -/]*[@-~]|[\u0000-\u0008\u000a-\u001f\u007f-\u009f\u200e\u200f\u2028\u2029\u202a-\u202e\u2066-\u2069\ufeff]/g;

/** Returns a control character and its sequence as Python writes it. */
function signOf(control) {
  const code = control.codePointAt(0);
  const sign = { 10: "\\n", 13: "\\r" }[code] ?? (code < 0x100 ? `\\x${code.toString(16).padStart(2, "0")}` : `\\u${code.toString(16).padStart(4, "0")}`);
  return sign + control.slice(1);
}

/** Draws any text literally: with its spaces and tabs, and with control characters as signs. */
function Written({ text }) {
  const shown = text.slice(0, LONGEST);
  const parts = [];
  let at = 0;
  for (const found of shown.matchAll(CONTROL)) {
    parts.push(shown.slice(at, found.index), html`<span class="control" title="a control character: it does nothing here">${signOf(found[0])}</span>`);
    at = found.index + found[0].length;
  }
  parts.push(shown.slice(at));
  const more = text.length - shown.length;
  return html`${parts}${more > 0 ? html`<span class="control"> … ${more.toLocaleString("en")} more characters; a copy has them</span>` : null}`;
}

/** Returns the notices that the shown run has given after another one, in order. */
function noticesAfter(number) {
  return notices.value.filter((notice) => notice.number > number && isGiven(notice)).toSorted((one, other) => one.events - other.events);
}

/** Returns the rows of a notice, broken between words: {notice, text}; `head` is true for the first, which also has the level and place. */
function rowsOf(notice) {
  const { text } = notice;
  const most = Math.max(20, columns.value);
  const before = "x".repeat(Math.min(textOf(notice).length - text.length, most)).replace(/x$/, " "); // the room for level and place
  const broken = new RegExp(`.{1,${most}}(?:\\s|$)|.{1,${most}}`, "gsu");
  const more = text.length - LONGEST;
  const shown = more > 0 ? `${text.slice(0, LONGEST)} … ${more.toLocaleString("en")} more characters; a copy has them` : text;
  const rows = `${before}${shown}`.split("\n").flatMap((line) => line.match(broken) ?? []);
  return rows.map((row, n) => ({ notice, head: n === 0, text: n === 0 ? row.slice(before.length) : row }));
}

/** The contents of the console: lines and notices, in order. Lines are one row each, notices as many as they need. */
class Listed {
  constructor(lines, messages) {
    this.lines = lines;
    this.rows = messages.flatMap(rowsOf);
    /** The position of each row of a notice among all rows. */
    this.places = this.rows.map(({ notice }, n) => firstWhere(lines, ({ number }) => number >= notice.events) + n);
    /** The number of rows. */
    this.length = lines.length + this.rows.length;
    this.count = lines.length + messages.length;
  }

  /** Returns [line, null] or [null, row of a notice]. */
  at(place) {
    const before = firstWhere(this.places, (one) => one >= place);
    return this.places[before] === place ? [null, this.rows[before]] : [this.lines[place - before], null];
  }

  /** Returns all contents as text. */
  get text() {
    const entries = Array.from({ length: this.length }, (_, n) => this.at(n)).filter(([line, row]) => line || row.head);
    return entries.map(([line, row]) => `${line ? line.text : textOf(row.notice)}\n`).join("");
  }
}

function textOf({ level, file, line, text }) {
  return `${level === "info" ? "" : `${level}: `}${file ? `${file}:${line}: ` : ""}${text}`;
}

/** Returns what is listed, and what is not. `memo` is `useMemo` where a component calls it. */
function listing(memo = (make) => make()) {
  const now = eventCount.value;
  const version = printedVersion.value;
  const wanted = words.value.toLowerCase();
  const has = (text) => text.toLowerCase().includes(wanted);
  const { lines, gaps, dropped, cleared, of } = printed();
  const present = firstWhere(lines, ({ number }) => number >= now);
  const first = Math.min(present, firstWhere(lines, ({ number }) => number >= cleared.events));
  const messages = noticesAfter(cleared.notice);
  const gone = first > 0 || noticesAfter(-1).length > messages.length;
  const shown = memo(() => {
    const past = first === 0 && present === lines.length ? lines : lines.slice(first, present);
    return wanted ? past.filter(({ text }) => has(text)) : past;
  }, [version, first, present, wanted]);
  const listed = new Listed(shown, wanted ? messages.filter((notice) => has(textOf(notice))) : messages);
  // Lines can arrive before the state of their moment; they are only ahead if the user has gone back.
  return { listed, ahead: inThePast.value ? lines.length - present : 0, all: present - first + messages.length, gaps, dropped, gone, of };
}

function Line({ entry: [line, row] }) {
  if (line) return html`<div><${Written} text=${line.text} /></div>`;
  const { level, file, line: number } = row.notice;
  const head = html`${level === "info" ? null : html`<span class="level">${level}</span> `}${file ? html`<${Place} file=${file} line=${number} /> ` : null}`;
  return html`<div class=${level}>${row.head ? head : null}<${Written} text=${row.text} /></div>`;
}

function Notes({ gaps, dropped, gone, all, ahead }) {
  const now = eventCount.value;
  const missing = gaps.reduce((sum, [from, to]) => sum + Math.max(0, Math.min(to, now) - from), 0);
  return html`
    ${dropped > 0 ? html`<p class="note">The first ${counted(dropped, "line is", "lines are")} left out: there are too many.</p>` : null}
    ${gone ? html`<p class="note" role="status">${all > 0 ? "Earlier lines" : "The lines up to this moment"} are cleared. <button class="link" onClick=${() => clear()}>Show all</button></p>` : null}
    ${missing > 0 ? html`<p class="note" role="status">${alive.value ? "Lines from earlier in the run are being fetched …" : `What was printed in ${counted(missing, "earlier event")} is not known here any more; the recording has it.`}</p>` : null}
    ${ahead > 0 ? html`<p class="note" role="status">${counted(ahead, "line")} printed after this moment ${ahead === 1 ? "is" : "are"} not shown.</p>` : null}
  `;
}

function save() {
  saveFile(`${pictureName(session.value ?? { model: "model" }, "console")}.txt`, new Blob([listing().listed.text], { type: "text/plain;charset=utf-8" }));
}

function clearAll() {
  clear(eventCount.peek(), Math.max(-1, ...notices.peek().map(({ number }) => number)));
}

const registered = (text, work) =>
  command({
    text,
    group: "Console",
    work: () => {
      goToTab("console"); // so that what is copied, saved or cleared is seen
      work();
    },
    ready: () => Boolean(session.value) && listing().listed.count > 0,
    why: () => (session.value ? "The console has no lines." : runStatus.value.text),
  });
registered("Copy the lines of the console", () => copyText(listing().listed.text));
registered("Save the lines of the console as a text file", save);
registered("Clear the console", clearAll);

function Console() {
  const box = useRef(null);
  const { width } = useSize(box);
  useLayoutEffect(() => {
    if (width > 0) columns.value = Math.floor((width - SIDES) / widthOf("0", { mono: true, size: 12 }));
  }, [width]);
  const { listed, ahead, all, gaps, dropped, gone, of } = listing(useMemo);
  useEffect(() => {
    const timer = setTimeout(fillGaps, 0);
    return () => clearTimeout(timer);
  }, [printedVersion.value, alive.value, moment.value]);
  const none = all > 0 ? "No line has that text." : ahead > 0 ? "Nothing was printed before this moment." : nothingYet("Nothing was printed in this run.").replace("Nothing has happened yet", "Nothing has been printed yet");
  return html`<div class="console" ref=${box}>
    <div class="tools" role="toolbar" aria-label="Console">
      <input type="search" aria-label="Search the console" placeholder="Search" value=${words.value} onInput=${(event) => (search.value = { of: shownRun.peek(), words: event.currentTarget.value })} />
      <span class="quiet number">${words.value ? `${listed.count} of ${counted(all, "line")}` : counted(all, "line")}</span>
      <${CopyButton} text="Copy" title="Copy the lines that are shown" disabled=${listed.count === 0} copied=${() => listed.text} />
      <${Button} disabled=${listed.count === 0} title="Save the lines that are shown as a text file" onClick=${save}><${Icon} name="download" />Save<//>
      <${Button} disabled=${all === 0} title="Clear the lines up to now; the run and its recording keep them" onClick=${clearAll}>Clear<//>
    </div>
    <${Notes} gaps=${gaps} dropped=${dropped} gone=${gone} all=${all} ahead=${ahead} />
    ${listed.count === 0 && (all > 0 || !gone) ? html`<p class="empty">${none}</p>` : null}
    <${Lines} label="What the model prints" count=${listed.length} of=${`${of} ${words.value}`} line=${(n) => html`<${Line} key=${n} entry=${listed.at(n)} />`} />
  </div>`;
}

export const panel = { id: "console", title: "Console", order: 9, View: Console };
