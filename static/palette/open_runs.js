// The other open runs and recordings, as commands that show them; they are listed when the palette is opened.

import { otherSessions, showSession } from "../bar/models.js";
import { commandsOf } from "../commands.js";
import { runs } from "../runs/list.js";
import { openText } from "../runs/wording.js";
import { session } from "../store.js";
import { signal } from "../vendor/preact.js";

const others = signal([]);

async function read() {
  others.value = await otherSessions(session.peek()?.id).catch(() => []); // without a list, none is offered
}

commandsOf(
  () =>
    others.value.map((one) => ({
      text: `Switch to the open ${openText(one, runs.value)}`,
      about: () => one.status ?? "",
      group: "Open runs",
      work: () => showSession(one),
    })),
  { read, needs: "models folder" },
);
