// Windows of their own for panels, the 3D view and the timeline: each is a page that shows the same run as the page that opened it.

import { alone, page } from "./address.js";
import { show } from "./server.js";
import { notify, session } from "./store.js";
import { computed, effect } from "./vendor/preact.js";

const PATIENCE = 400; // how long a window waits for the page that has opened it [ms]
const SIZES = { scene: [960, 720], timeline: [1200, 420] }; // [px]
const USUAL = [760, 620];

const channel = new BroadcastChannel("actr3d pages");

/** Opens a panel or a part of the page in a window of its own. */
export function openWindow(id) {
  const [width, height] = SIZES[id] ?? USUAL;
  const address = new URLSearchParams(location.search);
  address.set("panel", id);
  address.set("page", page);
  if (!open(`/?${address}`, `${page} ${id}`, `popup,width=${width},height=${height}`)) notify("The browser does not open a window: allow this page to.");
}

function announce() {
  if (session.peek()) channel.postMessage({ page, shown: session.peek().id });
}

if (alone === null) {
  channel.addEventListener("message", ({ data }) => data.page === page && data.asked && announce());
  const shown = computed(() => session.value?.id);
  effect(() => {
    shown.value;
    announce();
  });
}

/** Makes the page show what was chosen in this window of it: a `model`, or the recording `recorded` if that is not null. */
export function passOn(chosen) {
  if (alone !== null) channel.postMessage({ page, chosen });
}

/** Calls a function with what is chosen in windows of this page. */
export function followWindows(work) {
  if (alone === null) channel.addEventListener("message", ({ data }) => data.page === page && data.chosen && work(data.chosen));
}

/** Follows the page that has opened this window; `otherwise` is called if there is none any more. */
export function follow(otherwise) {
  const timer = setTimeout(otherwise, PATIENCE);
  channel.addEventListener("message", ({ data }) => {
    if (data.page !== page || !data.shown) return;
    clearTimeout(timer);
    show(data.shown);
  });
  channel.postMessage({ page, asked: true });
}
