// Copies a link to the moment of the run that is shown.

import { html } from "../vendor/preact.js";
import { addressOf } from "../address.js";
import { command, run } from "../commands.js";
import { buttonTitle } from "../keys.js";
import { Button } from "../parts/button.js";
import { confirmation, copyText } from "../parts/copy.js";
import { Icon } from "../parts/icon.js";
import { runStatus } from "../run_status.js";
import { session, shownRecording } from "../store.js";
import { present } from "../timeline/seek.js";

const { isShown, confirm } = confirmation();

async function copyLink() {
  const link = addressOf(shownRecording.peek(), present.peek());
  if (await copyText(link, "The link was not copied")) confirm();
}

const noLink = () => (session.value ? "This run is not recorded, so no link leads to it." : runStatus.value.text);
const sharing = command({ text: "Copy a link to this moment of the run", also: "share address URL", group: "Run", work: copyLink, ready: () => shownRecording.value !== null, why: noLink, needs: "models folder" });

export function Share() {
  const ready = sharing.ready();
  const copied = isShown.value;
  const why = session.value && !ready ? noLink() : buttonTitle(sharing);
  return html`<${Button} class="bare ${copied ? "good" : ""}" disabled=${!ready} title=${copied ? "Copied" : why} aria-label="Copy a link" onClick=${() => run(sharing)}>
    <${Icon} name=${copied ? "check" : "link"} /><span class="unseen" role="status">${copied ? "The link is copied" : ""}</span>
  <//>`;
}
