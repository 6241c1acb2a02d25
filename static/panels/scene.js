// The 3D view: viser's page in a frame that never moves, for moving it would load it again.

import { el } from "../dom.js";
import { store, watch } from "../store.js";

export function scene(root) {
  const nothing = el("p", {});
  let frame = null;
  let of = null;
  root.append(nothing);

  watch(["session"], () => {
    const { session } = store;
    const shown = Boolean(session?.world && session.scene);
    nothing.hidden = shown;
    nothing.textContent = session?.world ? "The 3D view is being made …" : session ? "This model has no world to show." : "";
    if (shown && !frame) {
      frame = el("iframe", { title: "3D view" });
      root.append(frame);
    }
    if (frame) frame.hidden = !shown;
    if (shown && of !== session.id) {
      of = session.id;
      frame.src = `/viser/${session.id}/`;
    }
  });
}
