// Puts the page together: one panel a file, each with its place in index.html.

import { place } from "./dom.js";
import { buffers } from "./panels/buffers.js";
import { controls } from "./panels/controls.js";
import { firings } from "./panels/firings.js";
import { log } from "./panels/log.js";
import { memory } from "./panels/memory.js";
import { models } from "./panels/models.js";
import { parameters } from "./panels/parameters.js";
import { recordings } from "./panels/recordings.js";
import { retina } from "./panels/retina.js";
import { scene } from "./panels/scene.js";
import { why } from "./panels/why.js";
import { store, watch } from "./store.js";

const panels = { models, controls, scene, parameters, buffers, why, memory, retina, recordings, firings, log };
for (const [id, panel] of Object.entries(panels)) panel(place(id));

watch(["connected"], () => {
  const line = place("connection");
  line.hidden = store.connected;
  line.textContent = store.connected ? "" : "The connection to the workbench is lost; trying again …";
});
