// The 3D view: viser's page in a frame that never moves, for moving it would load it again.

import { html, useRef } from "../vendor/preact.js";
import { RetinaInset } from "../eye/inset.js";
import { session } from "../store.js";
import { dark } from "../theme.js";

export function Scene() {
  const told = session.value;
  const shown = Boolean(told?.world && told.scene);
  const address = useRef("about:blank");
  if (shown) address.current = `/viser/${told.id}/${dark.value ? "?darkMode" : ""}`;
  const text = !told ? "" : told.world ? "The 3D view is being made …" : told.loading ? "The model is being loaded …" : told.kind ? "This model has no world to show." : "";
  return html`<section id="scene" class="scene" aria-label="3D view">
    <iframe title="3D view" src=${address.current} hidden=${!shown}></iframe>
    ${shown ? null : html`<p class="empty">${text}</p>`}
    <${RetinaInset} />
  </section>`;
}
