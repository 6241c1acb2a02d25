// The retina as a small picture over the 3D view; hidden while the tab Eye shows the large one, and closed by default in the view through the eye.

import { html, signal } from "../vendor/preact.js";
import { useAnswer } from "../parts/answer.js";
import { Icon } from "../parts/icon.js";
import { remembered } from "../local_storage.js";
import { openTab } from "../open_tab.js";
import { bodies } from "../store.js";
import { Retina } from "./retina.js";

const overScene = remembered("retina", innerWidth >= 900);
const overEyesView = signal(false); // there it would cover a part of the same picture

/** Returns the bodies of the run that have an eye. */
export function bodiesWithEye() {
  return Object.entries(bodies.value).filter(([, { eye: name }]) => name).map(([body]) => body);
}

export function RetinaInset({ through }) {
  const open = through ? overEyesView : overScene;
  const body = bodiesWithEye()[0];
  const shown = open.value && openTab.value !== "eye" && body !== undefined;
  const { answer } = useAnswer(shown ? { type: "view", body } : null, { live: true });
  if (body === undefined || openTab.value === "eye") return null;
  if (!open.value) return html`<button class="inset-closed" onClick=${() => (open.value = true)}>Eye</button>`;
  return html`<aside class="inset" aria-label="Retina">
    <header>
      <b title="eye of ${body}"><span class="of">eye of </span>${body}</b><span class="stretch"></span>
      <button class="bare" aria-label="Larger" title="Larger, with the table of edges" onClick=${() => (openTab.value = "eye")}><${Icon} name="more" /></button>
      <button class="bare" aria-label="Hide the retina" title="Hide" onClick=${() => (open.value = false)}><${Icon} name="close" /></button>
    </header>
    <${Retina} view=${answer} />
  </aside>`;
}
