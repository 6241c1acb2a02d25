// What the page remembers from one visit to the next: sizes, the theme, the open tab.

import { effect, signal } from "./vendor/preact.js";

const PREFIX = "actr3d.";

/** Returns a signal whose value is stored in the browser, if possible. */
export function remembered(name, otherwise) {
  const kept = signal(read(name, otherwise));
  effect(() => {
    try {
      localStorage.setItem(PREFIX + name, JSON.stringify(kept.value));
    } catch {
      // If the browser stores nothing, the value lasts until the page is closed.
    }
  });
  return kept;
}

function read(name, otherwise) {
  try {
    const value = JSON.parse(localStorage.getItem(PREFIX + name));
    return value === null || typeof value !== typeof otherwise ? otherwise : value;
  } catch {
    return otherwise;
  }
}
