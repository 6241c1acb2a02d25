// Light or dark: by the system's setting, or as the user has chosen.

import { addressed } from "./address.js";
import { computed, effect, signal } from "./vendor/preact.js";
import { remembered } from "./local_storage.js";

const system = matchMedia("(prefers-color-scheme: dark)");
const systemIsDark = signal(system.matches);
system.addEventListener("change", () => (systemIsDark.value = system.matches));

/** "system", "light" or "dark". */
export const chosen = addressed("theme") === null ? remembered("theme", "system", { everywhere: true }) : signal(addressed("theme"));
/** Whether the page is dark now; code that draws on a canvas reads it and draws again. */
export const dark = computed(() => (chosen.value === "system" ? systemIsDark.value : chosen.value === "dark"));

effect(() => {
  document.documentElement.style.colorScheme = dark.value ? "dark" : "light";
  document.documentElement.dataset.theme = dark.value ? "dark" : "light";
});

const LIGHT_DARK = /^light-dark\((.+),\s*(.+)\)$/;

/** Returns the value of one of the colours of style.css in the current theme, for a canvas or a saved picture. */
export function colour(name) {
  const value = getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  const both = LIGHT_DARK.exec(value);
  return both ? both[dark.peek() ? 2 : 1].trim() : value;
}

export function nextTheme() {
  const order = ["system", "light", "dark"];
  chosen.value = order[(order.indexOf(chosen.value) + 1) % order.length];
}
