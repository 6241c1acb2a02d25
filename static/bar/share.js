// Copies a link to the moment of the run that is shown.

import { html, signal } from "../vendor/preact.js";
import { addressOf } from "../address.js";
import { command, run } from "../commands.js";
import { buttonTitle } from "../keys.js";
import { Button } from "../parts/button.js";
import { copyText } from "../parts/copy.js";
import { Icon } from "../parts/icon.js";
import { runStatus } from "../run_status.js";
import { session, shownRecording } from "../store.js";
import { present } from "../timeline/seek.js";

const SHOWN = 2000; // how long the confirmation is shown [ms]
const copied = signal(0); // how many confirmations are shown

async function copyLink() {
  const link = addressOf(shownRecording.peek(), present.peek());
  if (!(await copyText(link, "The link was not copied"))) return;
  copied.value += 1;
  setTimeout(() => (copied.value -= 1), SHOWN);
}

const noLink = () => (session.value ? "This run is not recorded, so no link leads to it." : runStatus.value.text);
const sharing = command({ text: "Copy a link to this moment of the run", also: "share address URL", group: "Run", work: copyLink, ready: () => shownRecording.value !== null, why: noLink, needs: "models folder" });

export function Share() {
  const ready = sharing.ready();
  const why = session.value && !ready ? noLink() : buttonTitle(sharing);
  return html`<${Button} class="bare ${copied.value ? "good" : ""}" disabled=${!ready} title=${copied.value ? "Copied" : why} aria-label="Copy a link" onClick=${() => run(sharing)}>
    <${Icon} name=${copied.value ? "check" : "link"} /><span class="unseen" role="status">${copied.value ? "The link is copied" : ""}</span>
  <//>`;
}
