// The figure of an experiment: the mean of a measure by the levels of a factor, one line for each combination of others.

import { html, useEffect, useMemo, useRef, useSignal } from "../vendor/preact.js";
import { valueText } from "../parts/chunk.js";
import { counted } from "../parts/count.js";
import { SaveButtons } from "../parts/save_buttons.js";
import { useSize } from "../parts/size.js";
import { Problem } from "../parts/problem.js";
import { savePicture } from "../parts/picture.js";
import { CanvasSurface, scaled, wrapped } from "../parts/surface.js";
import { numberText } from "../parts/ticks.js";
import { valueWithUnit } from "../parts/units.js";
import { remembered } from "../local_storage.js";
import { dark } from "../theme.js";
import { usePolled } from "./polling.js";
import { drawFigure, drawLegend, drawSample, layout, layoutLegend, levelsOf } from "./drawing.js";
import { experiments, pathOf, showExperiment } from "./list.js";
import { changedText, columnText, doneText, experimentText, headText } from "./wording.js";

const MAX_LINES = 12;
const MAX_BUTTONS = 300; // points that keys can reach
const REACH = 12; // [px]
const NOTE = 16; // the height of a line of text below a saved figure [px]
const EMPTY = [];

/** What was chosen for the figures of a design: {name: {measure, x, by}}. */
const choices = remembered("figures", {});
/** The id of the experiment that is compared; "" for none. */
const compared = remembered("experiment compared", "");

const sizeOf = (facts, name) => facts.factors?.[name]?.length ?? (name === "group" ? Object.keys(facts.groups ?? {}).length : 0);

/** Returns the columns for the axis and the lines: factors and groups first, then all other values of a trial. */
function keysOf(facts, columns) {
  const first = [...Object.keys(facts.factors ?? {}), ...(Object.keys(facts.groups ?? {}).length > 1 ? ["group"] : [])];
  const others = columns.filter(({ role }) => role === "value").map(({ name }) => name);
  return [...new Set([...first, ...others, "participant", "repetition", "position"])].filter((name) => columns.some((column) => column.name === name));
}

const isMeasure = ({ role, name, type }) => (role === "measure" || name === "wall_s") && ["integer", "real", "boolean"].includes(type);

/** Returns the columns with one for each measure that has several numbered ones in the table: {..., over: what is numbered}. */
function joined(facts, columns) {
  const numbered = (facts.measures ?? []).filter(({ over }) => over);
  const measureOf = (column) => numbered.find(({ name }) => column.name.startsWith(`${name}_`) && /^\d+$/.test(column.name.slice(name.length + 1)));
  const found = columns.map((column) => (measureOf(column) ? { ...measureOf(column), unit: column.unit, type: "real", role: "measure" } : column));
  return found.filter(({ name }, n) => found.findIndex((one) => one.name === name) === n);
}

const overOf = (columns, measure) => columns.find(({ name }) => name === measure)?.over;

/** Returns what is shown unless the user has chosen otherwise. */
function defaults(facts, columns) {
  const keys = keysOf(facts, columns);
  const factors = keys.filter((name) => sizeOf(facts, name) > 1).toSorted((one, other) => sizeOf(facts, other) - sizeOf(facts, one));
  const x = factors.find((name) => facts.factors?.[name]?.every((level) => typeof level === "number")) ?? factors[0] ?? keys[0];
  const by = [];
  for (const name of factors.filter((one) => one !== x)) {
    if ([...by, name].reduce((product, one) => product * sizeOf(facts, one), 1) <= 6) by.push(name);
  }
  const measures = columns.filter(isMeasure).filter(({ name }) => name !== "wall_s");
  const measure = (measures.find(({ type }) => type === "real") ?? measures[0])?.name ?? "wall_s";
  return { x: overOf(columns, measure) ?? x, by: overOf(columns, measure) ? factors.slice(0, 1) : by, measure };
}

function chosenFor(name, facts, columns) {
  const otherwise = defaults(facts, columns);
  const { x, by, measure } = { ...otherwise, ...choices.value[name] };
  const chosen = columns.some(({ name: one }) => one === measure) ? measure : otherwise.measure;
  const over = overOf(columns, chosen);
  const known = (column) => column === over || columns.some((one) => one.name === column);
  const axis = [x, otherwise.x, over, ...keysOf(facts, columns)].find(known);
  return { x: axis, by: by.filter((one) => known(one) && one !== axis), measure: chosen, over };
}

/** Returns the address of the means of an experiment; with those of another one beside it, if there is one. */
function meansOf(id, { x, by, measure, over }, beside) {
  const options = Object.entries({ over, beside: beside?.id }).filter(([, value]) => value);
  return `${pathOf(id)}/means?${new URLSearchParams([["x", x], ["measure", measure], ...by.map((name) => ["by", name]), ...options])}`;
}

/** Returns the lines of means: {number, key, name, values, points, dashed, experiment}; the nth combination has the nth colour. */
function linesOf(answer, facts, combinations, dashed, experiment) {
  const groups = Map.groupBy(answer.points, ({ at }) => JSON.stringify(at.slice(1)));
  const levels = levelsOf(answer.points.map(({ at }) => at[0]), orderOf(facts, answer.x));
  const places = new Map(levels.map((level, n) => [JSON.stringify(level), n]));
  return combinations.flatMap((key, number) => {
    const points = groups.get(key);
    if (!points) return [];
    const values = JSON.parse(key);
    const name = values.map((value, n) => (typeof value === "string" ? value : `${columnText(answer.by[n])} ${valueText(value)}`)).join(" · ");
    return { number, key: `${experiment} ${key}`, name, values, dashed, experiment, points: points.toSorted((one, other) => places.get(JSON.stringify(one.at[0])) - places.get(JSON.stringify(other.at[0]))) };
  });
}

const orderOf = (facts, name) => facts.factors?.[name] ?? (name === "group" ? Object.keys(facts.groups ?? {}) : undefined);

/** Returns all combinations of the values of lines, as JSON, in the order of the design. */
function combinationsOf(answers, by, facts) {
  const all = [...new Set(answers.flatMap(({ points }) => points.map(({ at }) => JSON.stringify(at.slice(1)))))];
  const ranks = by.map((name, n) => new Map(levelsOf(all.map((key) => JSON.parse(key)[n]), orderOf(facts, name)).map((level, place) => [JSON.stringify(level), place])));
  const rank = (key) => JSON.parse(key).map((value, n) => ranks[n].get(JSON.stringify(value)));
  return all.toSorted((one, other) => rank(one).reduce((found, place, n) => found || place - rank(other)[n], 0));
}

/** Returns the name of an experiment among several of one design: when it began, and what was changed in the design. */
const nameAmong = (experiment) => `${experimentText(experiment)}, ${changedText(experiment.changed) || "as designed"}`;

/** Returns how many trials points are of; of a measure with several values a trial, how many values. */
function countsText(points, { over }, { total }) {
  const drawn = points.reduce((sum, { trials }) => sum + trials, 0);
  return over ? counted(drawn, "value") : doneText({ done: drawn, total });
}

/** Returns how many trials the points of one experiment, or of two, are of. */
function countsOf({ points, beside }, chosen, experiment, other) {
  const own = countsText(points, chosen, experiment);
  return other ? `${own}; of the other experiment, ${countsText(beside.points, chosen, other)}` : own;
}

/** Returns the entries of the legend for experiments, the lines of the second of which are dashed; none for a single one. */
function entriesOf(drawn) {
  return drawn.length === 1 ? [] : drawn.map((one, n) => ({ key: `experiment ${n}`, name: nameAmong(one), dashed: n === 1, colour: "quiet", number: 0 }));
}

function Menus({ experiment, facts, columns, chosen }) {
  const set = (changes) => (choices.value = { ...choices.newest(), [experiment.name]: { ...chosen, ...changes } });
  const keys = [...(chosen.over ? [chosen.over] : []), ...keysOf(facts, columns)];
  const measures = columns.filter(isMeasure);
  const measured = (measure) => set({ measure, ...(overOf(columns, measure) ? { x: overOf(columns, measure) } : {}) });
  const factors = keys.filter((name) => sizeOf(facts, name) > 1 && name !== chosen.x);
  const lines = [[], ...keys.filter((name) => name !== chosen.x).map((name) => [name]), ...(factors.length > 1 ? [factors.slice(0, 2)] : []), ...(factors.length > 2 ? [factors.slice(0, 3)] : [])];
  if (!lines.some((by) => by.join() === chosen.by.join())) lines.push(chosen.by);
  return html`<div class="menus">
    <select aria-label="Measure" title="What is averaged" value=${chosen.measure} onChange=${(event) => measured(event.currentTarget.value)}>
      ${measures.map(({ name, meaning }) => html`<option key=${name} value=${name} title=${meaning}>${columnText(name)}</option>`)}
    </select>
    <label>by <select aria-label="Axis" value=${chosen.x} onChange=${(event) => set({ x: event.currentTarget.value, by: chosen.by.filter((name) => name !== event.currentTarget.value) })}>
      ${keys.map((name) => html`<option key=${name} value=${name}>${columnText(name)}</option>`)}
    </select></label>
    <label>lines <select aria-label="Lines" value=${chosen.by.join()} onChange=${(event) => set({ by: event.currentTarget.value.split(",").filter(Boolean) })}>
      ${lines.map((by) => html`<option key=${by.join()} value=${by.join()}>${by.length === 0 ? "one" : by.map(columnText).join(" × ")}</option>`)}
    </select></label>
  </div>`;
}

/** Returns the other experiments that have what is shown: the measure, and the columns of the axis and the lines. */
function comparable(experiment, { x, by, measure, over }) {
  const needed = [over ? `${measure}_1` : measure, ...[x, ...by].filter((name) => name !== over)];
  return (experiments.value ?? []).filter(({ id, done, columns }) => id !== experiment.id && done > 0 && needed.every((name) => columns.includes(name)));
}

/** Returns whether there are means of both experiments to draw. */
const isDrawn = ({ points, beside }) => points.length > 0 && beside.points.length > 0;

/** Returns what two experiments are compared of, if not of all that each of them has; an empty text if there is nothing to say. */
function comparisonText(pair, other, over) {
  const { conditions: failed } = pair.failed;
  const whole = failed > 0 ? " in which no trial failed" : "";
  if (!isDrawn(pair)) {
    return `${experimentText(other)} is not compared: it has no condition${whole} in common with this experiment${pair.apart.length > 0 ? ` (the two share no level of ${pair.apart.map(columnText).join(" or ")})` : ""}.`;
  }
  const of = (trials, whose) => `${counted(trials, over ? "value" : "trial")} of ${whose}`;
  const names = ["this experiment", experimentText(other)];
  const alone = [pair.left_out, pair.beside.left_out].flatMap(({ conditions, trials }, n) => (trials > 0 ? [`${conditions > 0 ? `${counted(conditions, "condition")} with ` : ""}${of(trials, names[n])}`] : []));
  const left = failed > 0 ? [...alone, `${counted(failed, "condition")} in which a trial failed, with ${names.map((whose, n) => of(pair.failed.trials[n], whose)).join(" and ")}`] : alone;
  return left.length > 0 ? `Only conditions that both experiments have${whole ? ", and in which no trial failed," : ""} are compared. Left out: ${left.join("; ")}.` : "";
}

/** Returns what the points of a figure and their bars are. */
function meansText(points, { by_order: byOrder, failures }) {
  const without = points.filter(({ error }) => error === null).length;
  const bars = without < points.length ? `, ± 1 standard error${byOrder ? "" : " over participants"}` : "";
  const means = byOrder ? "Means of the participants" : "Means of the conditions, each weighing the same";
  const single = without > 0 ? ` No bar where ${byOrder ? "there is" : "a condition has"} one participant.` : "";
  return `${means}${bars}.${single}${failures > 0 ? " Without the trials that failed: those that are left may be the easier ones." : ""}`;
}

/** The choice of another experiment to draw beside this one. */
function ComparedChoice({ others, other }) {
  if (others.length === 0) return null;
  return html`<select aria-label="Compare with" title="Draw another experiment beside it" value=${other?.id ?? ""} onChange=${(event) => (compared.value = event.currentTarget.value)}>
    <option value="">compare with …</option>
    ${others.map((one) => html`<option key=${one.id} value=${one.id}>${nameAmong(one)}</option>`)}
  </select>`;
}

/** A sample of a line: its colour, dashes and mark. */
function Sample({ line }) {
  const canvas = useRef(null);
  useEffect(() => {
    drawSample(new CanvasSurface(scaled(canvas.current, 22, 10)), 0, 5, line);
  }, [line.number, line.dashed, dark.value]);
  return html`<canvas ref=${canvas} style="width: 22px; height: 10px" aria-hidden="true"></canvas>`;
}

/** Returns a point as text: where it is, its mean, and what it is the mean of. */
function pointText({ at, mean, error, participants, trials }, { x, unit }, line) {
  const bars = error === null ? "" : ` ± ${numberText(error)}`;
  const of = `${counted(participants, "participant")}, ${counted(trials, "trial")}`;
  return `${columnText(x)} ${valueText(at[0])}${line.name ? ` · ${line.name}` : ""}${line.dashed ? " · the other experiment" : ""}: ${valueWithUnit(`${numberText(mean)}${bars}`, unit)} (${of})`;
}

function Plot({ lines, known, about, children }) {
  const area = useRef(null);
  const canvas = useRef(null);
  const pointed = useSignal(null);
  const { width, height } = useSize(area);
  const figure = useMemo(() => layout(lines, known, width, height), [lines, known, width, height]);
  const legend = [...lines.filter(({ name, dashed, number }) => name && !(dashed && lines.some((one) => one.number === number && !one.dashed))), ...about.entries];
  const caption = `${meansText(lines.flatMap((line) => line.points), about)} ${about.counts}`;
  const title = headText({ name: about.measure, unit: about.unit });

  useEffect(() => {
    if (width > 0) drawFigure(new CanvasSurface(scaled(canvas.current, width, height)), lines, figure, about.across);
  }, [lines, figure, dark.value]);

  function save(kind) {
    const [wide, high] = [Math.max(640, width), Math.max(360, height)];
    const notes = [caption, about.comparison].filter(Boolean).flatMap((text) => wrapped(text, wide));
    const entries = layoutLegend(legend, wide);
    const draw = (surface) => {
      drawLegend(surface, entries);
      surface.at(0, entries.height, () => drawFigure(surface, lines, layout(lines, known, wide, high), about.across));
      notes.forEach((text, n) => surface.text(text, 0, entries.height + high + 8 + NOTE * n, "quiet"));
    };
    const [source] = about.sources;
    savePicture({ name: `${source} ${about.measure}`, title: `${title}, ${about.sources.join(" and ")}`, width: wide, height: entries.height + high + NOTE * notes.length, draw }, kind);
  }

  const points = lines.flatMap((line) => line.points.map((point) => ({ line, point, x: figure.xOf(point.at[0]), y: figure.yOf(point.mean), text: pointText(point, about, line) })));
  const leave = () => (pointed.value = null);
  const hit = pointed.value ? points.filter(({ text }) => pointed.value.includes(text)) : [];

  function point({ currentTarget, clientX, clientY }) {
    const { left, top } = currentTarget.getBoundingClientRect();
    const found = near(points, clientX - left, clientY - top).map(({ text }) => text);
    pointed.value = found.length > 0 ? found : null;
  }

  /** Shows the trials of points: of several in one place, those with the values that all share. */
  function show(some) {
    if (some.length === 0) return;
    const values = [about.x, ...about.by].map((name, n) => [name, some[0].point.at[n]]);
    showExperiment(some[0].line.experiment, Object.fromEntries(values.filter(([name, value], n) => name !== about.over && some.every((one) => one.point.at[n] === value))));
  }

  return html`<figure class="means" aria-label=${title}>
    <figcaption>
      <b>${title}</b>
      <span class="legend">${legend.map((line) => html`<span key=${line.key}><${Sample} line=${line} />${line.name}</span>`)}</span>
      ${children}
      <${SaveButtons} what="figure" save=${save} />
    </figcaption>
    <div class="area ${hit.length > 0 ? "hit" : ""}" ref=${area} onPointerMove=${point} onPointerLeave=${leave} onClick=${() => show(hit)}>
      <canvas ref=${canvas} role="img" aria-label=${title} style=${{ width: `${width}px`, height: `${height}px` }}></canvas>
      ${points.slice(0, MAX_BUTTONS).map((one) => {
        const key = `${one.line.key} ${one.point.at[0]}`;
        const press = (event) => (event.stopPropagation(), show([one]));
        return html`<button key=${key} class="point ${hit.includes(one) ? "hit" : ""}" style=${{ left: `${one.x}px`, top: `${one.y}px` }} aria-label="Trials of ${one.text}" onClick=${press} onFocus=${() => (pointed.value = [one.text])} onBlur=${leave}></button>`;
      })}
    </div>
    <p class="pointed" role="status">${hit.length > 0 ? html`${hit.length > 1 ? `${hit.length} points, ${hit[0].text}` : hit[0].text} <span class="quiet">– click for the trials${about.comparison ? " there, also those left out" : ""}</span>` : html`<span class="quiet">${caption}</span>`}</p>
  </figure>`;
}

/** Returns the points at a place: the nearest one within reach, and those that it covers. */
function near(points, x, y) {
  const far = (one) => Math.hypot(one.x - x, one.y - y);
  const nearest = points.reduce((best, one) => (best === null || far(one) < far(best) ? one : best), null);
  if (nearest === null || far(nearest) > REACH) return [];
  return points.filter((one) => Math.hypot(one.x - nearest.x, one.y - nearest.y) < 2);
}

/** @param experiment The summary of the experiment. @param facts Its facts. @param columns Its columns. */
export function Figure({ experiment, facts, columns: all }) {
  const columns = joined(facts, all);
  const { done, failures } = experiment;
  const failed = done > 0 && failures === done;
  const chosen = chosenFor(experiment.name, facts, columns);
  const comparables = comparable(experiment, chosen);
  const other = comparables.find(({ id }) => id === compared.value) ?? null;
  const alone = usePolled(failed ? null : meansOf(experiment.id, chosen), experiment.done);
  const wanted = other && !failed ? meansOf(experiment.id, chosen, other) : null;
  const both = usePolled(wanted, `${experiment.done} ${other?.done}`);
  const pair = wanted !== null && both.path === wanted ? both.answer : null;
  const together = pair !== null && isDrawn(pair);
  const answer = together ? pair : alone.answer;
  const lines = useMemo(() => {
    if (!answer) return EMPTY;
    const answers = together ? [answer, { ...answer, ...answer.beside }] : [answer];
    const combinations = combinationsOf(answers, answer.by, facts).slice(0, MAX_LINES);
    return answers.flatMap((one, n) => linesOf(one, facts, combinations, n === 1, n === 1 ? other.id : experiment.id));
  }, [answer, together, other?.id]);
  const drawn = together ? [experiment, other] : [experiment];
  const combined = answer ? combinationsOf([answer], answer.by, facts).length : 0;
  const problem = other && both.error;
  const error = alone.error ?? (problem ? `${experimentText(other)} is not compared: ${problem}.` : null);
  const comparison = pair ? comparisonText(pair, other, chosen.over) : "";
  if (failed) {
    return html`<p class="part empty" role="status">${done === 1 ? "The finished trial has failed" : `All ${done.toLocaleString("en")} finished trials have failed`}: there is nothing to draw. The table of trials has the errors.</p>`;
  }
  return html`
    <${Menus} experiment=${experiment} facts=${facts} columns=${columns} chosen=${chosen} />
    <div class="part">
      <${Problem} text=${error} />
      ${comparison ? html`<p class="problem warning">${comparison}</p>` : null}
      ${combined > MAX_LINES ? html`<p class="problem warning">The first ${MAX_LINES} of ${combined} lines are drawn.</p>` : null}
      ${answer && lines.length > 0
        ? html`<${Plot} lines=${lines} known=${orderOf(facts, answer.x)} about=${{ ...answer, comparison: together ? comparison : "", failures: together ? 0 : failures, over: chosen.over, across: headText(columns.find(({ name }) => name === answer.x) ?? { name: answer.x }), unit: answer.unit ?? "", sources: drawn.map(experimentText), counts: countsOf(answer, chosen, experiment, together && other), entries: entriesOf(drawn) }}><${ComparedChoice} others=${comparables} other=${other} /><//>`
        : html`<p class="empty" role="status">${answer ? "No finished trial has a value of this measure." : error ? "" : html`<progress aria-label="Reading"></progress> Reading the trials …`}</p>`}
    </div>
  `;
}
