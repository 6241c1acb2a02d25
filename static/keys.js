// The keys of the page: one place that knows them all, so that `?` can show them.

const known = new Map();

/** What keys are for, in the order in which they are shown. */
export const KEY_GROUPS = ["Run", "Timeline", "Panels", "Editor"];

/** Gives a key something to do. `key` is as in KeyboardEvent, "Shift+" or "Mod+" (Ctrl, or Cmd on a Mac) before it. Keys without
 * Mod do nothing while the user writes. Without a text it is not shown. */
export function bindKey(key, text, work, group = "Run") {
  known.set(key, { key, text, work, group });
}

/** Tells of a key that does something only in some part of the page, which attends to it itself. */
export function noteKey(key, text, group) {
  known.set(`${key} ${text}`, { key, text, group });
}

/** Returns the keys of a group with what they do, in the order in which they were bound. */
export function keysOf(wanted) {
  return [...known.values()].filter(({ text, group }) => text && group === wanted);
}

export const isMac = /Mac|iPhone|iPad/.test(navigator.platform);

/** Says a key as it stands on a keyboard. */
export function keyText(key) {
  const names = { " ": "Space", Delete: "Del", ArrowLeft: "←", ArrowRight: "→", ArrowUp: "↑", ArrowDown: "↓", Mod: isMac ? "⌘" : "Ctrl" };
  return key.split(/\+(?=.)/).map((part) => names[part] ?? (part.length === 1 ? part.toUpperCase() : part)).join(" ");
}

function isWriting(element) {
  if (element?.shadowRoot?.activeElement) return isWriting(element.shadowRoot.activeElement);
  if (element?.isContentEditable) return true;
  const takesText = element?.tagName === "INPUT" && !["range", "checkbox", "radio", "button"].includes(element.type);
  return takesText || ["TEXTAREA", "SELECT"].includes(element?.tagName);
}

addEventListener("keydown", (event) => {
  const mod = isMac ? event.metaKey : event.ctrlKey;
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const shift = event.shiftKey && (event.key.length > 1 || /[a-z]/i.test(event.key)) ? "Shift+" : "";
  const bound = known.get(`${mod ? "Mod+" : ""}${shift}${name}`);
  if (!bound?.work || event.altKey || event.defaultPrevented) return;
  if (document.querySelector("dialog[open]")) return;
  if (!mod && isWriting(document.activeElement)) return;
  // Space and Enter press the button that has the focus, arrows move sliders and tabs.
  const pressed = document.activeElement?.closest("button, a, summary, [role=tab], [role=separator], input, [role=slider]");
  if (!mod && pressed && ["  ", " ", "Enter", "ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"].includes(event.key)) return;
  event.preventDefault();
  bound.work();
});
