// The 3D view: viser's page in a frame that never moves, for moving it would load it again; and a strip of switches on its edge.

import { html, useRef } from "../vendor/preact.js";
import { RetinaInset } from "../eye/inset.js";
import { Icon } from "../parts/icon.js";
import { settable } from "../parts/settable.js";
import { remembered } from "../remembered.js";
import { rest } from "../rest.js";
import { opening, session } from "../store.js";
import { dark } from "../theme.js";

const open = remembered("scene switches", true);
const CAMERAS = { free: "free", follow: "with the body", eye: "through the eye", top: "from above" };

const camera = settable(
  () => session.value?.camera,
  (view) => ({ type: "camera", view }),
);
const overlays = new Map();

/** The switch of an overlay. */
function overlay(name) {
  if (!overlays.has(name)) {
    const told = () => Boolean(session.value?.overlays.find((one) => one.name === name)?.shown);
    overlays.set(name, settable(told, (shown) => ({ type: "overlay", name, shown })));
  }
  return overlays.get(name);
}

/** The switches of what is drawn over the scene, and from where it is seen; the same for all who watch. */
function Switches() {
  const { overlays, cameras } = session.value;
  if (!open.value) return html`<button class="switches-closed" title="What is drawn over the scene" onClick=${() => (open.value = true)}>Overlays</button>`;
  return html`<div class="switches" role="toolbar" aria-label="3D view">
    <label>Camera
      <select value=${camera.value.value} onChange=${(event) => camera.set(event.currentTarget.value)}>
        ${cameras.map((view) => html`<option key=${view} value=${view}>${CAMERAS[view] ?? view}</option>`)}
      </select>
    </label>
    ${overlays.map(
      ({ name, title }) => html`<label key=${name}>
        <input type="checkbox" checked=${overlay(name).value.value} onChange=${(event) => overlay(name).set(event.currentTarget.checked)} />${title}
      </label>`,
    )}
    <button class="bare" aria-label="Hide the switches" title="Hide" onClick=${() => (open.value = false)}><${Icon} name="close" /></button>
  </div>`;
}

/** Whether there will be something to see, or known that there is not, in a while. */
function awaited(told) {
  return told ? Boolean(told.world || told.loading) : Boolean(opening.value);
}

/** Says why there is nothing to see yet. */
function missing(told) {
  if (!told) return opening.value?.text ?? "";
  if (told.world) return "The 3D view is being made …";
  if (told.loading) return "The model is being loaded …";
  if (!told.kind) return "There is no run: what is wrong with the model stands in Messages, with its line.";
  return "This model has no world: there is nothing to see. Its buffers, productions and memory stand beside.";
}

export function Scene() {
  const told = session.value;
  const shown = Boolean(told?.world && told.scene);
  const address = useRef("about:blank");
  if (shown) address.current = `/viser/${told.id}/?panel=hidden${dark.value ? "&darkMode" : ""}`;
  return html`<section id="scene" class="scene" aria-label="3D view">
    <iframe onLoad=${(event) => event.currentTarget.contentWindow?.restWith?.(rest)} title="3D view" src=${address.current} hidden=${!shown}></iframe>
    ${shown ? html`<${Switches} />` : html`<div class="empty" role="status"><p>${missing(told)}</p>${awaited(told) ? html`<progress aria-label="Loading" />` : null}</div>`}
    <${RetinaInset} />
  </section>`;
}
