// Light or dark: as the system says, or as the user has chosen.

import { computed, effect, signal } from "./vendor/preact.js";
import { remembered } from "./remembered.js";

const system = matchMedia("(prefers-color-scheme: dark)");
const systemIsDark = signal(system.matches);
system.addEventListener("change", () => (systemIsDark.value = system.matches));

/** "system", "light" or "dark". */
export const chosen = remembered("theme", "system");
/** Whether the page is dark now; what draws on a canvas reads it and draws again. */
export const dark = computed(() => (chosen.value === "system" ? systemIsDark.value : chosen.value === "dark"));

effect(() => {
  document.documentElement.style.colorScheme = dark.value ? "dark" : "light";
  document.documentElement.dataset.theme = dark.value ? "dark" : "light";
});

const probe = document.createElement("span");
probe.hidden = true;
document.documentElement.append(probe);
const resolved = new Map();

/** Returns one of the colours of style.css as it is now, for a canvas. */
export function colour(name) {
  const key = `${name} ${dark.peek()}`;
  if (!resolved.has(key)) {
    probe.style.color = `var(--${name})`;
    resolved.set(key, getComputedStyle(probe).color);
  }
  return resolved.get(key);
}

export function nextTheme() {
  const order = ["system", "light", "dark"];
  chosen.value = order[(order.indexOf(chosen.value) + 1) % order.length];
}
