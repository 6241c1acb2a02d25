// The tabs beside the 3D view. A new panel is one file in panels/, and one line here.

import { remembered } from "./remembered.js";
import { buffers } from "./panels/buffers.js";
import { editor } from "./panels/editor.js";
import { eye } from "./panels/eye.js";
import { memory } from "./panels/memory.js";
import { messages } from "./panels/messages.js";
import { parameters } from "./panels/parameters.js";
import { productions } from "./panels/productions.js";
import { runs } from "./panels/runs.js";

export const TABS = [buffers, productions, memory, eye, parameters, editor, runs, messages];

/** The id of the tab that is open. */
export const openTab = remembered("tab", "buffers");
