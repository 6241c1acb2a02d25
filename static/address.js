// The address of the page: which model, or which recorded run and time; in a window of its own, which panel.

import { exactTime, timeOfText } from "./parts/units.js";

/** Returns a part of the address: "model", "run", "t", "copied", "panel", "page", "session" or "theme"; null for none. */
export function addressed(name) {
  return new URLSearchParams(location.search).get(name);
}

/** The id of the panel, or of the part of the page, that this window shows alone; null for the whole page. */
export const alone = addressed("panel");

/** The id of the session that this page shows in a notebook, without what belongs to a models folder; null for the workbench itself. */
export const embedded = addressed("session");

/** Identifies this window, also after a reload. */
export const ownName = takeName();

/** Identifies the page that this window belongs to: itself, unless it was opened by one. */
export const page = addressed("page") ?? ownName;

/** The name is stored only between two pages of this window: a browser that duplicates a tab copies what is stored. */
function takeName() {
  const name = sessionStorage.getItem("name") ?? String(Math.random()).slice(2);
  const take = () => sessionStorage.removeItem("name");
  take();
  addEventListener("pagehide", () => sessionStorage.setItem("name", name));
  addEventListener("pageshow", take); // the browser may show the same page again
  return name;
}

/** Returns the moment of the address [s]; null for none. */
export function addressedTime() {
  const time = timeOfText(addressed("t") ?? "");
  return Number.isFinite(time) && time >= 0 ? time : null;
}

/** Puts what is shown into the address: `kind` is "model" or "run". «Back» and «forward» switch between a recorded run and a model. */
export function goToAddress(kind, name) {
  if (addressed(kind) === name) return;
  const wanted = new URLSearchParams();
  for (const kept of ["panel", "page"]) if (addressed(kept) !== null) wanted.set(kept, addressed(kept));
  wanted.set(kind, name);
  const other = kind === "run" || addressed("run") !== null;
  history[other ? "pushState" : "replaceState"](null, "", `?${wanted}`);
}

/** Takes the moment out of the address: who loads the page again is not taken back to it. */
export function leaveMoment() {
  const wanted = new URLSearchParams(location.search);
  for (const name of ["t", "copied"]) wanted.delete(name);
  history.replaceState(null, "", `?${wanted}`);
}

/** Returns the whole address of a moment of a recorded run, as the run is now: it may be changed before that moment later. */
export function addressOf(run, time) {
  const now = Math.floor(Date.now() / 1000);
  return `${location.origin}/?${new URLSearchParams({ run, t: String(exactTime(time)), copied: String(now) })}`;
}
