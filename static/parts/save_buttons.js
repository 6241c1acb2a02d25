// Buttons that save a picture, or the values in it, as a file.

import { html } from "../vendor/preact.js";
import { Icon } from "./icon.js";

const TITLES = { png: (what) => `Save the ${what} as a PNG`, svg: (what) => `Save the ${what} as an SVG`, csv: () => "Save the values as CSV" };

/** @param what What the picture is, such as "plot". @param kinds Some of "png", "svg", "csv". @param save Called with one of them. */
export function SaveButtons({ what, kinds = ["png", "svg"], save }) {
  return kinds.map((kind) => html`<button key=${kind} class="bare" title=${TITLES[kind](what)} onClick=${() => save(kind)}><${Icon} name="download" />${kind.toUpperCase()}</button>`);
}
