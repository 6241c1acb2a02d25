// Which of the tabs beside the 3D view is open.

import { addressed } from "./address.js";
import { remembered } from "./local_storage.js";
import { signal } from "./vendor/preact.js";
import { embedded } from "./windows.js";

/** The id of the open tab; in a window of its own, of the panel that it shows. */
export const openTab = addressed("panel") === null ? remembered("tab", embedded === null ? "about" : "buffers") : signal(addressed("panel"));
