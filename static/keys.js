// The keys of the page: those of its commands, and those that work in some part of it only.

import { commandOf, permanent, run } from "./commands.js";
import { isAvailable } from "./needs.js";

const notes = [];

/** The groups of keys, in the order in which they are shown. */
export const KEY_GROUPS = ["Run", "Timeline", "3D view", "Panels", "Page", "Editor"];

/** Lists a key that only works in some part of the page, which handles it itself; not on a page without what it needs (needs.js). */
export function noteKey(key, text, group, needs = null) {
  if (isAvailable(needs)) notes.push({ key, text, group });
}

/** Returns the keys of a group with their texts. */
export function keysOf(wanted) {
  return [...permanent(), ...notes].filter(({ key, group }) => key && group === wanted);
}

const isMac = /Mac|iPhone|iPad/.test(navigator.platform);

/** Returns whether Mod is held with a key or the pointer: Ctrl, or Cmd on a Mac. */
export const hasMod = ({ ctrlKey, metaKey }) => (isMac ? metaKey : ctrlKey);

/** Returns a key's name as on a keyboard. */
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

/** Keys with Mod that have a meaning of their own in text fields. */
const OF_TEXT = ["Mod+z"];

/** Keys that the focused element handles itself: buttons are pressed, sliders and tabs moved. */
const OWN = {
  "Space Enter NumpadEnter": "button, a, summary, [role=tab], [type=checkbox], [type=radio]",
  "ArrowLeft ArrowRight ArrowUp ArrowDown Home End PageUp PageDown": "[role=tab], [role=separator], [role=slider], [type=range], [type=radio]",
};

const SLIDER = "[role=slider], [type=range]"; // keeps its own keys after use by pointer too

// After use by pointer, the keys belong to the page again: not to the tab or button that has the focus from a click. A select element
// would capture all letters.
let byPointer = false;
const pointed = new WeakSet(); // the elements that have the focus by pointer
addEventListener("pointerdown", ({ target }) => {
  byPointer = true;
  if (document.activeElement.contains(target)) pointed.add(document.activeElement);
}, true);
addEventListener("keydown", () => (byPointer = false), true);
addEventListener("focusin", ({ target, relatedTarget }) => {
  if (relatedTarget?.closest("dialog") && !target.closest("dialog")) return; // a closed dialog gives the focus back
  if (byPointer) pointed.add(target);
  else pointed.delete(target);
});
addEventListener("change", ({ target }) => byPointer && target.tagName === "SELECT" && target.blur());

/** Returns whether the element handles a key itself. */
function isOwn(element, { code, shiftKey }) {
  return !shiftKey && Object.entries(OWN).some(([keys, where]) => keys.split(" ").includes(code) && element?.closest(where));
}

/** Returns whether the page handles a key instead of the element that has the focus by pointer. */
function isTaken(element, event) {
  return pointed.has(element) && !element.matches(SLIDER) && isOwn(element, event);
}

/** Returns the title of the button of a command, or of a key that only works in some part of the page: its text, or another one, and its key. */
export function buttonTitle({ text, key }, shown = text) {
  return key ? `${shown} (${keyText(key)})` : shown;
}

/** Runs the command of a key; returns whether there is one, and the page takes the key. Keys without Mod, and those of text fields, are
 * ignored while the user types. */
function press(event) {
  const mod = hasMod(event);
  const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const shift = event.shiftKey && (event.key.length > 1 || /[a-z]/i.test(event.key)) ? "Shift+" : "";
  const bound = commandOf(`${mod ? "Mod+" : ""}${shift}${name}`);
  if (!bound || event.altKey || event.defaultPrevented) return false;
  if (document.querySelector("dialog[open]")) return false;
  if (bound.key === "Escape" ? !bound.ready() || document.querySelector(":popover-open") : (!mod || OF_TEXT.includes(bound.key)) && isWriting(document.activeElement)) return false;
  const focused = document.activeElement?.checkVisibility() ? document.activeElement : null; // for a moment it may lie in a dialog that was just closed
  if (!mod && isOwn(focused, event) && !isTaken(focused, event)) return false;
  event.preventDefault();
  run(bound);
  return true;
}

const CAMERA = ["KeyW", "KeyA", "KeyS", "KeyD", "KeyQ", "KeyE"]; // these move the camera of the 3D view
let inner = null; // the window of the 3D view

/** Handles the keys of the 3D view's window too: they work as elsewhere on the page; the 3D view gets only the camera keys. */
export function hearKeys(frame) {
  inner = frame;
  // The browser does not report whether the focus came into a frame by a key.
  frame.addEventListener("pointerdown", () => (byPointer = true), true);
  frame.addEventListener("focus", () => frame.frameElement.classList.toggle("reached", !byPointer));
  frame.addEventListener("blur", () => frame.frameElement.classList.remove("reached"));
  for (const kind of ["keydown", "keyup"]) {
    frame.addEventListener(
      kind,
      (event) => {
        if ((kind === "keydown" && press(event)) || !CAMERA.includes(event.code)) event.stopImmediatePropagation();
      },
      true,
    );
  }
}

/** Passes a camera key to the 3D view, wherever the focus is on the page. */
function handOn(event) {
  const { type, key, code, ctrlKey, metaKey, altKey } = event;
  const free = !ctrlKey && !metaKey && !altKey && !event.defaultPrevented && !isWriting(document.activeElement) && !document.querySelector("dialog[open]");
  if (!CAMERA.includes(code) || (type === "keydown" && !free)) return;
  inner?.document?.dispatchEvent(new inner.KeyboardEvent(type, { key, code }));
}

/** Runs the command of a key before the element with the focus by pointer gets it. */
function pressFirst(event) {
  const { activeElement } = document;
  if (!isTaken(activeElement, event) || !press(event)) return;
  event.stopImmediatePropagation();
  activeElement.blur(); // otherwise some browsers press a button when Space is released
}

addEventListener("keydown", pressFirst, true);
addEventListener("keydown", (event) => press(event) || handOn(event));
addEventListener("keyup", handOn);
