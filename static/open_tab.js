// Which of the tabs beside the 3D view is open.

import { alone, embedded } from "./address.js";
import { remembered } from "./local_storage.js";
import { signal } from "./vendor/preact.js";

/** The id of the open tab; in a window of its own, of the panel that it shows. */
export const openTab = alone === null ? remembered("tab", embedded === null ? "about" : "buffers") : signal(alone);

/** Opens a tab by a command. The focus moves to its panel, or to the element in it with `data-focus`, unless the command moves it to
 * something else. */
export function goToTab(id) {
  const before = document.activeElement;
  openTab.value = id;
  requestAnimationFrame(() => {
    const { activeElement, body } = document;
    const panel = document.getElementById(`panel-${id}`);
    if (![before, body].includes(activeElement) || (activeElement !== panel && panel?.contains(activeElement))) return;
    const inside = panel?.querySelector("[data-focus]");
    (inside?.checkVisibility() ? inside : panel)?.focus({ preventScroll: true });
  });
}
