// What the 3D view adds to viser, in viser's page: this browser's camera, ground and sky, labels. The server sends the data with each
// state (`window.scene`, see `viser_shim.js`); everything changes just before each picture, so that all of it shows the same moment.

import { SceneCamera } from "./camera.js";
import { Cutaway } from "./cutaway.js";
import { Ground } from "./ground.js";
import { Captions } from "./captions.js";
import { pictureOf } from "./picture.js";
import { Sharpness } from "./sharpness.js";
import { VIEWS } from "./stage.js";

const { scene: given } = window;
const HIDDEN = ["/overlays/frustum", "/overlays/handles"]; // not drawn in the view through the eye

/** Returns viser's own objects, once there is a scene and data for it. Until then nothing is drawn: pictures with viser's own lights and
 * shadows, which nobody sees, would take a browser without a graphics card a second. */
async function ready() {
  given.beforeFrame = () => {
    if (window.__viserMutable?.scene) window.__viserMutable.scene.visible = false;
  };
  for (;;) {
    const viewer = window.__viserMutable;
    if (viewer?.scene && viewer.cameraControl && viewer.backgroundMaterial && viewer.nodeRefFromName[""] && given.facts.stage && given.facts.now) return viewer;
    await new Promise((done) => setTimeout(done, 15));
  }
}

/** Returns "dark" or "light", from the surrounding page or viser's own setting. */
function theme() {
  const { theme: around } = parent === window ? {} : parent.document.documentElement.dataset;
  return around ?? (document.documentElement.dataset.mantineColorScheme === "dark" ? "dark" : "light");
}

const VISER_DRAWS = 250; // how long viser draws picture after picture once something has changed [ms]
const ENOUGH = 60; // how long that is if the processor draws, which has other work to do [ms]: two or three pictures

/** Draws for a shorter time after each change; what viser loads later requests a picture itself. */
function drawLess() {
  const { requestRender } = viewer;
  viewer.requestRender = () => {
    const { now } = performance;
    performance.now = () => now.call(performance) - (VISER_DRAWS - ENOUGH); // viser adds its time to this
    try {
      requestRender();
    } finally {
      delete performance.now;
    }
  };
}

const viewer = await ready();
if (given.bySoftware) drawLess();
const camera = new SceneCamera(viewer);
const ground = new Ground(viewer);
const labels = new Captions();
const cutaway = new Cutaway(viewer);
let stage = null; // of the scene that is drawn
let shaded = null;
let leftOut = false;

/** Hides what a view omits, and shows it again in other views if viser shows it. */
function leaveOut() {
  const through = camera.view === "eye";
  if (!through && !leftOut) return;
  leftOut = through;
  const nodes = window.__viserSceneTree.getState();
  for (const [name, object] of Object.entries(viewer.nodeRefFromName)) {
    if (object && HIDDEN.some((one) => name.startsWith(one))) object.visible = !through && nodes[name]?.effectiveVisibility !== false;
  }
}

const OVER = ".inset, .inset-closed, .view-bar"; // what the page shows over the picture

/** Returns the rectangles of the picture that the page covers. */
function covered(kinds = OVER) {
  if (parent === window) return [];
  const { left, top } = frameElement.getBoundingClientRect();
  return [...frameElement.parentElement.querySelectorAll(kinds)].map((one) => {
    const box = one.getBoundingClientRect();
    return { left: box.left - left, top: box.top - top, width: box.width, height: box.height };
  });
}

const MOST = 0.5; // the largest part of the picture that counts as covered
const part = (share) => Math.min(MOST, Math.max(0, share));

/** Returns what the page covers of the picture: the tools from the top, and the retina from the right, except where the body is in the
 * middle, which the retina leaves free. */
camera.coveredIn = (view) => {
  const [bar] = covered(".view-bar");
  const [inset] = view === "follow" ? [] : covered(".inset");
  return { right: inset ? part(1 - inset.left / innerWidth) : 0, top: bar ? part((bar.top + bar.height) / innerHeight) : 0 };
};

/** Returns the camera to the start of its view if another part of the picture is covered now, unless the user has moved it. */
function reframe() {
  viewer.requestRender();
  const { view, touched, covered: before } = camera;
  if (touched || view === "eye" || innerWidth === 0) return; // without a width, the page does not show it
  const { right, top } = camera.coveredIn(view);
  if (right !== before.right || top !== before.top) choose();
}

/** Returns the number of the moment at which the shapes are drawn; null as long as there are no shapes. */
function drawnNumber() {
  let number = null;
  viewer.nodeRefFromName["/moment"]?.traverse((object) => {
    if (object.instancesCount) number = object.getPositionAt(0).x;
  });
  return number;
}

/** Returns the data of the moment at which the shapes are drawn: viser moves them some pictures after the data have arrived (`Moments`
 * in `workbench/viser_server.py`). */
function drawnNow() {
  const number = drawnNumber() ?? Infinity;
  const later = given.heard.findIndex(({ moment }) => moment > number);
  given.heard.splice(0, (later < 0 ? given.heard.length : Math.max(later, 1)) - 1);
  return given.heard[0];
}

function choose() {
  if (stage !== null && isWhole()) camera.choose(given.view, stage, drawnNow(), given.kept);
  else waiting = true;
  viewer.requestRender();
}

const PATIENCE = 10_000; // a scene is shown after this time [ms], whatever is missing
let since = null; // when a scene was first incomplete [ms]
let waiting = false; // whether a view was chosen meanwhile

/** Returns whether the lights and all shapes of the newest scene are there: viser removes those of the former scene at once, and reads
 * new ones one by one. */
function isWhole() {
  const first = given.heard.find((now) => now.stage === given.facts.stage);
  if (first === undefined) return false;
  if (stage === given.facts.stage) return true;
  const number = drawnNumber();
  if (number === null || number < first.moment || !viewer.nodeRefFromName["/light/0"]) return false;
  return Object.entries(window.__viserSceneTree.getState()).every(([name, node]) => {
    if (!/Glb/.test(node?.message.type)) return true;
    let shapes = 0;
    viewer.nodeRefFromName[name]?.traverse((object) => (shapes += object.isMesh ? (object.instancesCount ?? 1) : 0));
    return shapes > 0;
  });
}

/** Keeps the last picture of the former scene, or what covers the page's first one, until all shapes of a new one are there. */
function keepFormer(renderer) {
  const { render } = renderer;
  const sharpness = new Sharpness(renderer, () => renderer.render(viewer.scene, viewer.camera), given.isHurried);
  renderer.render = (scene, seenBy) => {
    const isView = scene === viewer.scene && seenBy === viewer.camera;
    if (isView && !isWhole()) {
      since ??= performance.now();
      if (performance.now() - since < PATIENCE) {
        viewer.requestRender();
        return;
      }
    }
    since = null;
    given.beforeFrame = null;
    viewer.scene.visible = true;
    if (isView && !isTaking) sharpness.before();
    render.call(renderer, scene, seenBy);
    if (isView && !isDrawn) parent.postMessage({ drawn: true }, location.origin);
    isDrawn ||= isView;
  };
}

let isDrawn = false; // whether there has been a picture
let kept = false;
let isTaking = false; // whether a picture is taken to be saved

viewer.scene.onBeforeRender = (renderer, _, seenBy) => {
  if (seenBy !== viewer.camera) return;
  if (renderer.toneMapping) renderer.toneMapping = 0; // unchanged colours
  if (!kept) {
    kept = true;
    keepFormer(renderer);
    given.picture = (sharpness, canvas) => {
      isTaking = true;
      try {
        return pictureOf({ renderer, viewer, ground, labels }, sharpness, canvas);
      } finally {
        isTaking = false;
      }
    };
    viewer.requestRender();
    return; // this picture has begun without the rest
  }
  const now = drawnNow();
  if (now.stage !== stage) {
    // Another scene: if its stage differs, the camera returns to the start of its view.
    const same = JSON.stringify({ ...now.stage, grounds: 0 }) === JSON.stringify({ ...stage, grounds: 0 });
    const kept = stage === null || waiting ? given.kept : null;
    ({ stage } = now);
    if (!same || waiting) camera.choose(given.view, stage, now, kept);
    waiting = false;
  }
  given.shown = now;
  camera.follow(stage, now);
  leaveOut();
  cutaway.draw(stage, now, camera);
  if (now !== shaded) {
    ground.shade(now.shade, stage.ground);
    shaded = now;
  }
  const shade = theme();
  labels.layer.dataset.theme = shade;
  ground.draw(shade, camera.horizon(stage), stage, camera.flat);
  labels.draw(now.labels, now.heads, camera, covered);
};

/** Without a surrounding page, it has buttons of its own. */
function addSwitches() {
  const bar = document.createElement("div");
  bar.className = "scene-views";
  const select = document.createElement("select");
  select.setAttribute("aria-label", "Camera");
  select.append(...Object.entries(VIEWS).map(([view, title]) => new Option(title, view, false, view === given.view)));
  select.onchange = () => given.choose(select.value);
  const reset = document.createElement("button");
  reset.textContent = "Reset view";
  reset.onclick = () => given.choose(given.view);
  bar.append(select, reset);
  document.body.append(bar);
}

if (parent === window && new URLSearchParams(location.search).get("panel") !== "hidden") addSwitches();
/** The time of the moment at which the shapes are drawn [s]; null if it is not known. */
given.drawnTime = () => (isWhole() ? (drawnNow()?.time ?? null) : null);
given.onview = choose;
given.camera = camera;
choose();
const draws = new MutationObserver(() => viewer.requestRender());
if (parent !== window) {
  new MutationObserver(reframe).observe(frameElement.parentElement, { childList: true });
  addEventListener("resize", reframe);
}
draws.observe((parent === window ? document : parent.document).documentElement, { attributeFilter: ["data-theme", "data-mantine-color-scheme"] });
