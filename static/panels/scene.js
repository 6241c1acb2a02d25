// The 3D view: viser's page in a frame that never moves, because moving it would reload it; and the buttons on its edge.

import { html, signal, useEffect, useRef, useSignal } from "../vendor/preact.js";
import { askAndMake, changesOf, noChange } from "../changes/changes.js";
import { RetinaInset } from "../eye/inset.js";
import { command, commandsOf } from "../commands.js";
import { hearKeys, noteKey, buttonTitle } from "../keys.js";
import { AreaMenu } from "../parts/area_menu.js";
import { Button } from "../parts/button.js";
import { dialog } from "../parts/dialog.js";
import { Icon } from "../parts/icon.js";
import { ManualLink } from "../parts/manual.js";
import { pictureName, saveFile, SHARPNESS } from "../parts/picture.js";
import { optimistic } from "../parts/optimistic_value.js";
import { remembered } from "../local_storage.js";
import { rememberedByModel } from "../model_storage.js";
import { frameBudget } from "../frame_budget.js";
import { VIEWS } from "../scene/stage.js";
import { runStatus } from "../run_status.js";
import { runTimeText } from "../timeline/seek.js";
import { openWindow } from "../windows.js";
import { alive, hasScene, notify, running, session, state } from "../store.js";

const open = signal(false); // whether the list of overlays is shown
const view = remembered("view", "follow");
if (!(view.value in VIEWS)) view.value = "follow";
const resets = signal(0); // how often the view was reset
const { kept: freeCamera, keep: keepCamera } = rememberedByModel("free cameras of models", "camera"); // where the user has left it
const BETWEEN = 250; // the interval between two checks of the time that the 3D view shows [ms]
const LATE = 0.5; // the delay of the 3D view from which it is reported [s]
const NO_WEBGL =
  "This browser cannot draw in 3D: WebGL is off or missing. Turn on hardware acceleration, or use another browser. Everything else works.";

const overlays = new Map();

/** The switch of an overlay. */
function overlay(name) {
  if (!overlays.has(name)) {
    const reported = () => Boolean(session.value?.overlays.find((one) => one.name === name)?.shown);
    overlays.set(name, optimistic(reported, (shown) => ({ type: "overlay", name, shown })));
  }
  return overlays.get(name);
}

function hideByEscape(event) {
  if (event.key !== "Escape" || !open.value) return;
  event.stopPropagation();
  open.value = false;
  document.querySelector(".view-bar [aria-expanded]").focus();
}

/** The controls for this browser's view of the scene, and for the overlays shared by all viewers. */
function ViewBar() {
  return html`<div class="view-controls"><div class="view-bar" role="toolbar" aria-label="3D view">
      <select aria-label="Camera" title=${buttonTitle(next, "From where the scene is seen")} value=${view.value} onChange=${(event) => (view.value = event.currentTarget.value)}>
        ${Object.entries(VIEWS).map(([id, title]) => html`<option key=${id} value=${id}>${title}</option>`)}
      </select>
      <button aria-label="Reset view" title=${buttonTitle(reset)} onClick=${resetView}><${Icon} name="restart" /></button>
      ${canMove() ? html`<${Button} aria-label=${moving.text} disabled=${!moving.ready()} title=${noChange.value || "Move or push a body or an object of the scene"} onClick=${moveOrPush}><span class="in-words">${moving.text}</span><${Icon} name="move" /><//>` : null}
      <button aria-expanded=${open.value} aria-label="Overlays" title="Overlays: what is drawn over the scene" onClick=${() => (open.value = !open.value)} onKeyDown=${hideByEscape}><span class="in-words">Overlays</span><${Icon} name="layers" /></button>
      <button aria-label="Save the 3D view as a picture" title=${buttonTitle(keep)} onClick=${keepPicture}><${Icon} name="download" /></button>
      <${Button} aria-label="Make a video of the 3D view" title=${film.ready() ? buttonTitle(film) : film.why()} disabled=${!film.ready()} onClick=${makeVideo}><${Icon} name="film" /><//>
      <${ManualLink} page="scene" title="3D view" />
      <${AreaMenu} area="scene" opening=${openScene} />
    </div>
    ${open.value &&
    html`<div class="overlay-list" role="group" aria-label="Overlays" onKeyDown=${hideByEscape}>
      ${session.value.overlays.map(
        ({ name, title }) => html`<label key=${name}>
          <input type="checkbox" checked=${overlay(name).value.value} onChange=${(event) => overlay(name).set(event.currentTarget.checked)} />${title}
        </label>`,
      )}
    </div>`}</div>`;
}

function canMove() {
  return alive.value && changesOf("object").length > 0 && session.value.world?.objects?.length > 0;
}

/** Asks which change is to be made, and for the rest. */
async function moveOrPush() {
  const list = changesOf("object");
  const actions = list.map((one) => ({ text: `${one.title} …`, value: one }));
  const body = html`<dl class="change-help">${list.map((one) => html`<dt>${one.title}</dt><dd>${one.help}</dd>`)}</dl><p class="quiet">The overlay «handles to move things» moves them with the mouse.</p>`;
  const chosen = await dialog({ title: "Change by hand", body, actions });
  if (chosen) askAndMake(chosen);
}

/** Moves the camera back to the start of the chosen view. */
function resetView() {
  if (view.value === "free") keepCamera(null);
  resets.value += 1;
}

/** Chooses the next view. */
function nextView() {
  const views = Object.keys(VIEWS);
  view.value = views[(views.indexOf(view.value) + 1) % views.length];
}

/** Saves what the 3D view shows now. */
function keepPicture() {
  const name = pictureName(session.peek(), `at ${state.peek().time.toFixed(2)} s`);
  const drawn = document.querySelector("#scene iframe").contentWindow.scene?.picture?.(SHARPNESS);
  drawn?.toBlob((blob) => saveFile(`${name}.png`, blob), "image/png");
}

/** Asks for a stretch of the run, and makes a video of it. */
async function makeVideo() {
  try {
    const { askForVideo } = await import("../video/dialog.js"); // only few visits need it
    await askForVideo();
  } catch (error) {
    notify(error.message);
  }
}

const isShown = () => hasScene.value;
const noView = () => "This model has no 3D view.";
const next = command({ text: "Next view: with the body, free, from the side, from above, through the eye", key: "v", group: "3D view", work: nextView, ready: isShown, why: noView });
const reset = command({ text: "Reset view", key: "Shift+v", group: "3D view", work: resetView, ready: isShown, why: noView });
const keep = command({ text: "Save the 3D view as a picture (PNG)", also: "export download screenshot", group: "3D view", work: keepPicture, ready: isShown, why: noView });
const film = command({ text: "Make a video of the 3D view (WebM) …", also: "export film movie", group: "3D view", work: makeVideo, ready: () => isShown() && alive.value, why: () => (isShown() ? runStatus.value.text : noView()) });
commandsOf(() => (isShown() ? Object.entries(VIEWS).map(([id, title]) => ({ text: `View: ${title}`, also: id, group: "3D view", work: () => (view.value = id) })) : []));
commandsOf(() => (session.value?.overlays ?? []).map(({ name, title }) => {
  const shown = overlay(name).value.value;
  return { text: `${shown ? "Hide" : "Show"} overlay: ${title}`, group: "3D view", work: () => overlay(name).set(!shown), ready: isShown, why: noView };
}));
const moving = command({ text: "Move, push …", also: "change by hand body object place", group: "3D view", work: moveOrPush, ready: () => canMove() && !noChange.value, why: () => noChange.value || "There is nothing in a scene that can be moved." });
const openScene = command({ text: "Open the 3D view in a window of its own", group: "Page", work: () => openWindow("scene"), ready: isShown, why: noView });
noteKey("double click", "Look at the thing that is clicked", "3D view");
noteKey("W A S D Q E", "Move the camera, where it is free", "3D view");

/** Shows the time of the 3D view if it cannot keep up with the run. */
function Lag({ frame }) {
  const shown = useSignal(null);
  useEffect(() => {
    if (!running.value) return undefined;
    const timer = setInterval(() => {
      const time = frame.current?.contentWindow?.scene?.drawnTime?.() ?? NaN;
      const { time: now, measured } = state.peek() ?? {};
      shown.value = now - time > LATE * (measured ?? Infinity) ? time : null;
    }, BETWEEN);
    return () => {
      clearInterval(timer);
      shown.value = null;
    };
  }, [running.value]);
  return shown.value === null ? null : html`<p class="scene-lag number" title="The run goes faster than this machine can draw it">3D view of ${runTimeText(shown.value, 1)}</p>`;
}

/** Returns why there is no picture: [text, whether there will be one]; null if there is one. `drawn` is reported by the frame. */
function missing(drawn) {
  if (isShown()) return drawn === null ? ["The 3D view loads …", true] : drawn ? null : [NO_WEBGL, false];
  if (state.value === null) return [runStatus.value.text, runStatus.value.is === "loading"];
  return ["This model has no world: there is nothing to show here. See the tabs Buffers, Productions and Memory.", false];
}

function Cover({ text, awaited }) {
  return html`<div class="empty scene-cover" role="status"><p>${text}</p>${awaited ? html`<progress aria-label="Loading" />` : null}</div>`;
}

export function Scene() {
  const facts = session.value;
  const shown = isShown();
  const address = useRef("about:blank");
  const frame = useRef(null);
  const pictured = useSignal({ of: "", drawn: null });
  useEffect(() => {
    const hear = ({ source, data }) => {
      if (source !== frame.current.contentWindow) return;
      if (typeof data?.drawn === "boolean") pictured.value = { of: address.current, drawn: data.drawn };
      if (Array.isArray(data?.camera)) keepCamera(data.camera);
      if (data?.focused && view.value === "follow") view.value = "free"; // what is focused stays in the middle
    };
    addEventListener("message", hear);
    return () => removeEventListener("message", hear);
  }, []);
  if (shown) address.current = `/viser/${facts.id}/?panel=hidden`;
  const lacks = missing(pictured.value.of === address.current ? pictured.value.drawn : null);
  const loads = useSignal(0);
  useEffect(() => {
    frame.current.contentWindow?.scene?.choose(view.value, freeCamera.peek());
  }, [view.value, resets.value, loads.value]);
  function begin({ currentTarget: { contentWindow: inner } }) {
    inner?.useFrameBudget?.(frameBudget);
    if (shown && inner) hearKeys(inner);
    loads.value += 1;
  }
  return html`<section id="scene" class="scene" aria-label="3D view">
    <iframe key=${address.current} ref=${frame} onLoad=${begin} title="3D view" src=${address.current} hidden=${!shown}></iframe>
    ${lacks ? html`<${Cover} text=${lacks[0]} awaited=${lacks[1]} />` : html`<${ViewBar} /><${Lag} frame=${frame} />`}
    <${RetinaInset} through=${view.value === "eye"} />
  </section>`;
}
