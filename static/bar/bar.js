// The top bar: the model, its aperture, and the controls of the run.

import { html } from "../vendor/preact.js";
import { command } from "../commands.js";
import { buttonTitle } from "../keys.js";
import { Icon } from "../parts/icon.js";
import { chosen, nextTheme } from "../theme.js";
import { Aperture } from "./aperture.js";
import { Clock } from "./clock.js";
import { help } from "./help.js";
import { opening } from "../palette/palette.js";
import { ModelChoice } from "./models.js";
import { Transport } from "./transport.js";

const theme = command({ text: "Theme: light, dark, or as the system has it", key: "t", group: "Page", work: nextTheme });

export function Bar() {
  return html`<header class="bar">
    <h1>ACT-R 3D</h1>
    <${ModelChoice} />
    <${Transport} />
    <${Clock} />
    <${Aperture} />
    <span class="stretch"></span>
    <button class="bare" title=${buttonTitle(opening)} aria-label="All commands" onClick=${opening.work}><${Icon} name="search" /></button>
    <button class="bare" title=${buttonTitle(theme, `Theme: ${chosen.value}`)} aria-label="Theme: ${chosen}" onClick=${nextTheme}><${Icon} name="theme" /></button>
    <button class="bare" title=${buttonTitle(help)} aria-label="Help" onClick=${help.work}><${Icon} name="help" /></button>
  </header>`;
}
