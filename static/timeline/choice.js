// The menu for the plotted curves.

import { html } from "../vendor/preact.js";
import { choose, chosen, names, titleOf } from "./curves.js";

export function CurveChoice() {
  const groups = new Map();
  for (const curve of names.value) groups.set(curve.group, [...(groups.get(curve.group) ?? []), curve]);
  const set = (name, on) => choose(on ? [...chosen.value, name] : chosen.value.filter((one) => one !== name));
  return html`<div class="curve-choice">
    ${[...groups].map(
      ([group, curves]) => html`<fieldset key=${group}>
        <legend>${titleOf(group)} <span class="quiet">[${[...new Set(curves.map(({ unit }) => unit))].join(", ")}]</span></legend>
        ${curves.map(
          ({ name }) => html`<label key=${name} title=${name}>
            <input type="checkbox" checked=${chosen.value.includes(name)} onChange=${(event) => set(name, event.currentTarget.checked)} />
            <span>${name}</span>
          </label>`,
        )}
      </fieldset>`,
    )}
    <p><button onClick=${() => choose(null)}>The usual ones</button></p>
  </div>`;
}
