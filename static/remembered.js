// What the page remembers from one visit to the next: sizes, the theme, which tab is open.

import { effect, signal } from "./vendor/preact.js";

const PREFIX = "actr3d.";

/** Returns a signal whose value outlives the page, where the browser keeps such things. */
export function remembered(name, otherwise) {
  const kept = signal(read(name, otherwise));
  effect(() => {
    try {
      localStorage.setItem(PREFIX + name, JSON.stringify(kept.value));
    } catch {
      // A browser that keeps nothing: it holds until the page is left.
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
