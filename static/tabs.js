// The tabs beside the 3D view. A new panel is one file in panels/, and one line here.

import { bindKey, noteKey } from "./keys.js";
import { remembered } from "./remembered.js";
import { about } from "./panels/about.js";
import { buffers } from "./panels/buffers.js";
import { consoleTab } from "./panels/console.js";
import { editor } from "./panels/editor.js";
import { eye } from "./panels/eye.js";
import { memory } from "./panels/memory.js";
import { messages } from "./panels/messages.js";
import { parameters } from "./panels/parameters.js";
import { productions } from "./panels/productions.js";
import { runs } from "./panels/runs.js";

export const TABS = [about, buffers, productions, memory, eye, parameters, editor, runs, consoleTab, messages];

/** The id of the open tab. */
export const openTab = remembered("tab", "about");

TABS.forEach(({ id }, n) => bindKey(String((n + 1) % 10), "", () => (openTab.value = id)));
noteKey("1 … 9, 0", "Open a tab", "Panels");
noteKey("w", "Why, of a line of the firing trace", "Panels");
noteKey("b", "Breakpoint, in the list of productions", "Panels");
noteKey("Enter", "Go to a line of the trace; open a run", "Panels");
noteKey("Delete", "Delete the chosen runs", "Panels");
