// What the eye sees: extents by row, colour by label, shade by distance.

import { el } from "../dom.js";
import { say } from "../server.js";
import { store, watch } from "../store.js";

export function retina(root) {
  const canvas = el("canvas", { width: 300, height: 200 });
  const box = el("div", { hidden: true }, el("h2", {}, "Eye"), canvas);
  root.append(box);
  let asking = false;
  watch(["state"], async () => {
    const eye = Object.entries(store.session?.world?.bodies ?? {}).find(([, body]) => body.eye);
    box.hidden = !eye;
    if (!eye || asking || !store.session.alive) return;
    asking = true;
    try {
      draw(canvas, await say({ type: "view", body: eye[0] }));
    } catch {
      canvas.getContext("2d").clearRect(0, 0, canvas.width, canvas.height);
    }
    asking = false;
  });
}

function draw(canvas, { rows, extents }) {
  const context = canvas.getContext("2d");
  context.clearRect(0, 0, canvas.width, canvas.height);
  const height = canvas.height / rows;
  for (const [row, label, , left, right, near, far] of extents) {
    const light = 30 + Math.min(50, ((near + far) / 2) * 5);
    context.fillStyle = `hsl(${(label * 67) % 360} 60% ${light}%)`;
    context.fillRect(left * canvas.width, row * height, Math.max(1, (right - left) * canvas.width), Math.ceil(height));
  }
}
