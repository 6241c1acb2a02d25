// Small icons for buttons, drawn in a square of 16; they have the colour of the text.

import { html } from "../vendor/preact.js";

const PATHS = {
  run: "M4 2.5v11l9-5.5z",
  pause: "M4 2.5h3v11H4zM9 2.5h3v11H9z",
  step: "M3 2.5v11l7-5.5zM11 2.5h2v11h-2z",
  back: "M13 2.5v11L6 8zM3 2.5h2v11H3z",
  cycle: "M2 2.5v11L8 8zM8 2.5v11L14 8z",
  restart: "M8 2a6 6 0 1 0 6 6h-2a4 4 0 1 1-4-4v3l5-4-5-4z",
  seed: "M2 2h12v12H2zM4 4v8h8V4zM5.5 5.5h2v2h-2zM8.5 8.5h2v2h-2z",
  stop: "M3 3h10v10H3z",
  until: "M2 7h7V3.5L13.5 8 9 12.5V9H2zM13.5 2.5H15v11h-1.5z",
  theme: "M8 1a7 7 0 1 0 0 14A7 7 0 0 0 8 1zm0 2v10A5 5 0 0 1 8 3z",
  close: "M3.5 2.5 8 7l4.5-4.5 1 1L9 8l4.5 4.5-1 1L8 9l-4.5 4.5-1-1L7 8 2.5 3.5z",
  more: "M2 7h2.5v2H2zM6.75 7h2.5v2h-2.5zM11.5 7H14v2h-2.5z",
  search: "M7 2a5 5 0 1 0 3 9l3.3 3.3 1-1L11 10A5 5 0 0 0 7 2zm0 1.5a3.5 3.5 0 1 1 0 7 3.5 3.5 0 0 1 0-7z",
  download: "M7 1.5h2v7l2.5-2.5 1.2 1.2L8 12 3.3 7.2 4.5 6 7 8.5zM2 13h12v1.7H2z",
  film: "M1 3.500h9.500v9H1zM11.500 7.300 15 5v6l-3.500-2.300z",
  copy: "M5 1.5h9v10h-3v3H2v-10h3zm1.5 1.5v1.5H11V10h1.5V3zM3.5 6v7h6V6z",
  file: "M3 1.5h6.500L13 5v9.500H3zm1.500 1.500v10h7V6H8.500V3zM7.250 7.500h1.500v1.500h1.500v1.500h-1.500V12h-1.500v-1.500h-1.500V9h1.500z",
  pen: "M11.500 1.500 14.500 4.500 5.500 13.500 1.500 14.500 2.500 10.500zM10.500 4.200 4 10.800l-.4 1.600 1.600-.4 6.600-6.500z",
  check: "M6.200 12.800 1.800 8.400l1.400-1.400 3 3L12.800 3.400l1.400 1.400z",
  trash: "M6 1.5h4l.5 1H14V4H2V2.5h3.5zM3 5h10l-.8 9.5H3.8z",
  help: "M8 1a7 7 0 1 0 0 14A7 7 0 0 0 8 1zm.9 10.8H7.1V10h1.8zm1.6-5c-.7.8-1.6 1.1-1.6 2.3H7.2c0-1.7 1-2.1 1.6-2.7.6-.7.3-1.7-.8-1.7-.8 0-1.3.5-1.4 1.4L5 5.9C5.1 4 6.3 3.2 8 3.2c2.6 0 3.600 1.900 2.500 3.600z",
  book: "M1 2.500h5a2 2 0 0 1 2 1 2 2 0 0 1 2-1h5v11h-5.500L8 14.500 6.500 13.500H1zM2.500 4v8H7V4.800A.8.8 0 0 0 6.200 4zM9.800 4a.8.8 0 0 0-.8.8V12h4.500V4z",
  up: "M3 10.500 8 5.500l5 5z",
  down: "M3 5.500 8 10.500l5-5z",
  right: "M5.500 3 10.500 8l-5 5z",
  window: "M2 4h9v10H2zM3.500 7v5.500h6V7zM6 1.500h8.500V10H13V3H6z",
  layout: "M1.500 2.500h13v11h-13zM3 4v8h5V4zM9.500 4v3.500h3.500V4zM9.500 9v3h3.500V9z",
  link: "M6.300 9.700 9.700 6.300l1 1-3.400 3.400zM9 3.200l1-1a3.200 3.200 0 0 1 4.500 4.500l-2.300 2.300-1-1 2.200-2.300A1.800 1.800 0 0 0 10.900 3.300L10 4.200zM7 12.800l-1 1a3.200 3.200 0 0 1-4.500-4.500L3.800 7l1 1-2.200 2.300a1.800 1.800 0 0 0 2.500 2.400L6 11.800z",
};

export function Icon({ name }) {
  return html`<svg class="icon" viewBox="0 0 16 16" width="14" height="14" aria-hidden="true" focusable="false">
    <path fill="currentColor" fill-rule="evenodd" d=${PATHS[name]} />
  </svg>`;
}
