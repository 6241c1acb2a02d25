// Which of the tabs beside the 3D view is open.

import { remembered } from "./remembered.js";

/** The id of the open tab. */
export const openTab = remembered("tab", "about");
