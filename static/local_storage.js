// What the page remembers from one visit to the next: sizes, the theme, the open tab.

import { effect, signal } from "./vendor/preact.js";

const PREFIX = "actr3d.";

/** Returns a signal whose value is stored in the browser, if possible, once it is set: until then, the next visit has its own default. Its
 * `newest()` returns the value that is stored now: another tab may have set it. What collects entries adds to that, so that no tab loses
 * those of another. With `everywhere`, what is set in one tab or window counts in all at once. */
export function remembered(name, otherwise, { everywhere = false } = {}) {
  const kept = signal(read(name, otherwise));
  let stored = kept.peek(); // or the default
  effect(() => {
    if (kept.value === stored) return;
    stored = kept.value;
    try {
      localStorage.setItem(PREFIX + name, JSON.stringify(stored));
    } catch {
      // If the browser stores nothing, the value lasts until the page is closed.
    }
  });
  if (everywhere) addEventListener("storage", ({ key }) => key === PREFIX + name && (kept.value = read(name, otherwise)));
  return Object.assign(kept, { newest: () => read(name, kept.peek()) });
}

function read(name, otherwise) {
  try {
    const value = JSON.parse(localStorage.getItem(PREFIX + name));
    return value === null || typeof value !== typeof otherwise ? otherwise : value;
  } catch {
    return otherwise;
  }
}
