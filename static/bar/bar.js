// The top bar: the model, its aperture, and the controls of the run.

import { html } from "../vendor/preact.js";
import { bindKey } from "../keys.js";
import { Icon } from "../parts/icon.js";
import { chosen, nextTheme } from "../theme.js";
import { Aperture } from "./aperture.js";
import { Clock } from "./clock.js";
import { showHelp } from "./help.js";
import { ModelChoice } from "./models.js";
import { Transport } from "./transport.js";

bindKey("t", "Light, dark, or as the system has it", nextTheme, "Panels");

export function Bar() {
  return html`<header class="bar">
    <h1>ACT-R 3D</h1>
    <${ModelChoice} />
    <${Transport} />
    <${Clock} />
    <${Aperture} />
    <span class="stretch"></span>
    <button class="bare" title="Theme: ${chosen} (T)" aria-label="Theme: ${chosen}" onClick=${nextTheme}><${Icon} name="theme" /></button>
    <button class="bare" title="Help: the manual and the keys (?)" aria-label="Help" onClick=${showHelp}><${Icon} name="help" /></button>
  </header>`;
}
