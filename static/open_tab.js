// Which of the tabs beside the 3D view is open.

import { remembered } from "./local_storage.js";

/** The id of the open tab. */
export const openTab = remembered("tab", "about");
