// Deleted models, recordings and experiments lie in the trash folder: the message that says so restores them.

import { call } from "../server.js";
import { notify } from "../store.js";

/** Says that things are in the trash folder, and offers to restore them.
 * @param what The start of the sentence, such as "2 recordings are".
 * @param trash Their paths there, as deleting them has returned them.
 * @param after Called after they were restored. */
export function offerRestore(what, trash, after) {
  notify(`${what} in the trash folder.`, "info", { text: "Restore", work: () => restore(trash, after) });
}

async function restore(trash, after) {
  for (const one of trash) {
    try {
      await call("POST", "/api/restore", { trash: one });
    } catch (error) {
      notify(`Not restored: ${one}: ${error.message}`);
    }
  }
  await after();
}
