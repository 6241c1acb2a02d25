// The curves of two runs, drawn over each other and aligned in time.

import { html, useEffect, useMemo, useSignal } from "../vendor/preact.js";
import { Plot } from "../parts/plot.js";
import { Problem } from "../parts/problem.js";
import { toggled } from "../parts/toggled.js";
import { call, recordingPath } from "../server.js";
import { beginningText, nameOf } from "../runs/wording.js";

/** The colours of the two runs, in plots and headings. */
export const SIDE_COLOURS = ["series-1", "series-2"];
const MAX_MOMENTS = 20_000; // moments per curve: every tick of a run of up to 200 s
const AT_FIRST = 3; // the number of curves shown before the user has chosen any
const USUAL = ["speed", "clearance", "learned utility", "retrieval latency", "utility", "activation", "time busy", "time full"]; // their groups, in this order
const SIDES = ["first", "second"];
const DASHES = [null, [6, 3]];

function query(names) {
  return names.map((name) => `name=${encodeURIComponent(name)}`).join("&");
}

/** Returns the joint that moves most; undefined if there is none. */
async function moving(run, known) {
  const joints = known.filter(({ group }) => group === "joint").map(({ name }) => name);
  if (joints.length === 0) return undefined;
  const samples = await call("GET", `${recordingPath(run.id)}/curves?most=100&${query(joints.slice(0, 100))}`);
  const reach = (name) => Math.max(...samples.curves[name]) - Math.min(...samples.curves[name]);
  return joints.filter((name) => name in samples.curves).sort((one, other) => reach(other) - reach(one))[0];
}

/** Returns the default curves: the joint that moves most, and one of each of the usual groups. */
async function first(runs, known) {
  const usual = USUAL.map((wanted) => known.find(({ group, of }) => wanted === (of ?? group))?.name);
  return [await moving(runs[0], known), ...usual].filter(Boolean).slice(0, AT_FIRST);
}

/** Stores which curves exist, which are chosen, and their values in both runs. */
function useCurves(runs) {
  const known = useSignal(null); // [{name, unit, group, of, shape}] of both runs
  const chosen = useSignal([]);
  const samples = useSignal({}); // by run and name: {times, values, slope?}
  const error = useSignal(null);
  const key = runs.map(({ id }) => id).join();

  useEffect(() => {
    let over = false;
    known.value = null;
    async function begin() {
      const both = await Promise.all(runs.map((run) => call("GET", `${recordingPath(run.id)}/curves?most=2&name=-`)));
      const all = new Map(both.flatMap(({ names }) => names).map((curve) => [curve.name, curve]));
      const names = [...all.values()];
      const shown = names.length > 0 ? await first(runs, names) : [];
      if (!over) [known.value, chosen.value, error.value] = [names, shown, null];
    }
    begin().catch((reason) => !over && (error.value = reason.message));
    return () => (over = true);
  }, [key]);

  useEffect(() => {
    let over = false;
    async function complete(run) {
      const missing = chosen.value.filter((name) => !samples.value[`${run.id} ${name}`]);
      if (missing.length === 0) return;
      const { times, curves, events } = await call("GET", `${recordingPath(run.id)}/curves?most=${MAX_MOMENTS}&${query(missing)}`);
      if (over) return;
      const more = missing.map((name) => [`${run.id} ${name}`, events[name] ?? { times, values: curves[name] ?? [] }]);
      samples.value = { ...samples.value, ...Object.fromEntries(more) };
    }
    Promise.all(runs.map(complete)).catch((reason) => !over && (error.value = reason.message));
    return () => (over = true);
  }, [key, chosen.value]);

  return { known: known.value, chosen, samples: samples.value, error: error.value };
}

function Choice({ known, chosen }) {
  const groups = [...Map.groupBy(known, ({ group, of }) => of ?? group)];
  const toggle = (name) => (chosen.value = toggled(chosen.value, name));
  const add = (event) => {
    const name = event.currentTarget.value;
    event.currentTarget.value = "";
    if (name && !chosen.value.includes(name)) toggle(name);
  };
  return html`<select aria-label="Add a curve" value="" onChange=${add}>
      <option value="">Add a curve …</option>
      ${groups.map(([group, list]) => html`<optgroup key=${group} label=${group}>
        ${list.map(({ name }) => html`<option key=${name} value=${name} disabled=${chosen.value.includes(name)}>${name}</option>`)}
      </optgroup>`)}
    </select>
    <span class="picked">
      ${chosen.value.map((name) => html`<button key=${name} aria-label="Remove ${name}" title="Remove" onClick=${() => toggle(name)}>${name} <span aria-hidden="true">✕</span></button>`)}
    </span>`;
}

function Overlaid({ curve, runs, samples, cursor, span }) {
  const both = runs.map((run) => samples[`${run.id} ${curve.name}`]);
  const series = useMemo(
    () =>
      both.flatMap((of, n) =>
        of?.values.some((value) => value !== null)
          ? [{ name: `${SIDES[n]}: ${beginningText(runs[n], true)}`, unit: curve.unit, shape: curve.shape, times: of.times, values: of.values, slope: of.slope ?? undefined, until: runs[n].time, colour: SIDE_COLOURS[n], dash: DASHES[n] }]
          : [],
      ),
    [...both],
  );
  if (both.some((of) => !of)) return html`<p class="waiting quiet" role="status"><progress aria-label="Reading"></progress> ${curve.name} …</p>`;
  if (series.length === 0) return html`<p class="waiting quiet">Neither run has values of ${curve.name}.</p>`;
  return html`<${Plot} title=${curve.name} series=${series} span=${span} cursor=${cursor} height=${130} source="of ${runs.map(nameOf).join(" and ")}" />`;
}

/** @param runs Both runs, as the server describes them. */
export function Curves({ runs }) {
  const { known, chosen, samples, error } = useCurves(runs);
  const cursor = useSignal(null);
  const span = { from: 0, to: Math.max(0.01, ...runs.map(({ time }) => time)) };
  return html`<section class="overlaid" aria-label="Curves">
    <header><h3>Curves</h3>${known?.length ? html`<${Choice} known=${known} chosen=${chosen} />` : null}</header>
    <${Problem} text=${error && `The curves cannot be read: ${error}`} />
    ${!known && !error ? html`<p class="waiting quiet" role="status"><progress aria-label="Reading"></progress> Reading the curves …</p>` : null}
    ${known?.length === 0 ? html`<p class="empty">Neither run has numbers over time.</p>` : null}
    ${known && known.length > 0 && chosen.value.length === 0 ? html`<p class="empty">Add a curve to see both runs over one another.</p>` : null}
    ${(known ?? []).length > 0 ? chosen.value.map((name) => html`<${Overlaid} key=${name} curve=${known.find((curve) => curve.name === name)} runs=${runs} samples=${samples} cursor=${cursor} span=${span} />`) : null}
  </section>`;
}
