// The menu for the plotted curves.

import { html, useEffect, useSignal } from "../vendor/preact.js";
import { counted } from "../parts/count.js";
import { chosen, isOfChunk, names, notComputed, offered, plot, plotUsual, titleOf } from "./curves.js";

const MAX_LISTED = 40; // the maximum number of curves shown of one list: the others are found by their names

function Group({ title, curves, all }) {
  const units = [...new Set(curves.map(({ unit }) => unit))].filter(Boolean).join(", ");
  return html`<fieldset>
    <legend>${title} ${units ? html`<span class="quiet">[${units}]</span>` : null}</legend>
    ${curves.slice(0, all ? curves.length : MAX_LISTED).map(
      ({ name }) => html`<label key=${name} title=${name}>
        <input type="checkbox" checked=${chosen.value.includes(name)} onChange=${(event) => plot(name, event.currentTarget.checked)} />
        <span>${name}</span>
      </label>`,
    )}
    ${curves.some(({ name }) => isOfChunk(name)) ? notComputed.value.map((why) => html`<p key=${why} class="quiet">${why}</p>`) : null}
    ${!all && curves.length > MAX_LISTED ? html`<p class="quiet">${counted(curves.length - MAX_LISTED, "other")}: filter by name</p>` : null}
  </fieldset>`;
}

export function CurveChoice() {
  const sought = useSignal("");
  useEffect(() => {
    offered.value = true;
    return () => (offered.value = false);
  }, []);
  const wanted = sought.value.trim().toLowerCase();
  const found = names.value.filter(({ name, group, of }) => `${of ?? titleOf(group)} ${name}`.toLowerCase().includes(wanted));
  const groups = Map.groupBy(found, ({ group, of }) => of ?? titleOf(group));
  return html`<div class="curve-choice">
    <p class="curve-tools">
      <input type="search" aria-label="Filter curves" placeholder="Filter" value=${sought.value} onInput=${(event) => (sought.value = event.currentTarget.value)} />
      <button onClick=${plotUsual}>Default curves</button>
    </p>
    ${[...groups].map(([title, curves]) => html`<${Group} key=${title} title=${title} curves=${curves} all=${groups.size === 1} />`)}
    ${groups.size === 0 ? html`<p class="empty">No curve has this in its name.</p>` : null}
  </div>`;
}
