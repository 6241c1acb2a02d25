// The dialog that makes a video of the 3D view: of which stretch of the run, at which speed; then how far it is.

import { html, signal } from "../vendor/preact.js";
import { dialog } from "../parts/dialog.js";
import { pictureName, saveFile } from "../parts/picture.js";
import { Problem } from "../parts/problem.js";
import { plainTime, TIMES, timeOfText, timeText, timeUnit } from "../parts/units.js";
import { counted } from "../parts/count.js";
import { session } from "../store.js";
import { furthest } from "../timeline/seek.js";
import { encoderFor } from "./encoder.js";
import { countOf, LONGEST, makeVideo, RATE, sizeNow } from "./maker.js";

const TITLE = "Video of the 3D view";
const SPEEDS = [["1/4 x", 0.25], ["1/2 x", 0.5], ["1 x", 1], ["2 x", 2]];
const NO_ENCODER =
  "This browser cannot make videos: it has no WebCodecs with VP9 or VP8. Chrome, Edge, Firefox (from 130) and Safari (from 16.4) have, at an address that begins with https:// or on this computer (localhost).";

/** Returns a time of the run, rounded down, so that the run has been there. */
const roundedDown = (time) => Math.floor(time * 100 + 1e-6) / 100;
/** Returns a time of the run, as a field shows it. */
const entry = (time, reached) => plainTime(roundedDown(time), 2, reached);
/** Returns a time as it stands in the name of a file. */
const seconds = (time) => `${time.toFixed(2)} s`;

/** Returns what is wrong with the entries by field: an empty object for nothing. */
export function problemsOf(texts, reached) {
  const wrong = {};
  for (const name of ["begin", "end"]) {
    const text = texts[name].trim();
    const time = timeOfText(text);
    if (!Number.isFinite(time)) wrong[name] = `must be a time, such as ${TIMES} (got '${text}')`;
    else if (time < 0 || time > reached + 1e-7) wrong[name] = `must be from 0 to ${timeText(roundedDown(reached))}, which the run has reached (got ${text})`;
  }
  if (wrong.begin || wrong.end) return wrong;
  const stretch = stretchOf(texts);
  const { begin, end } = stretch;
  if (end <= begin) return { end: `must be later than the first time, ${timeText(begin, 2, reached)} (got ${texts.end.trim()})` };
  const length = countOf(stretch) / RATE;
  return length > LONGEST + 1 / RATE ? { end: `a video has at most ${LONGEST / 60} minutes (this one has ${(length / 60).toFixed(1)})` } : {};
}

function stretchOf({ begin, end, speed }) {
  return { begin: timeOfText(begin), end: timeOfText(end), speed: Number(speed) };
}

/** Shows a text instead, and waits until it is closed. */
const explain = (text) => dialog({ title: TITLE, body: html`<p>${text}</p>` });

/** Asks for a stretch of the run, makes the video and saves it; what is wrong is shown in the dialog, which stays open then. */
export async function askForVideo() {
  const size = sizeNow();
  if (size === null) return explain("The 3D view has not been drawn yet.");
  if ((await encoderFor(size, RATE)) === null) return explain(NO_ENCODER);
  if (furthest.peek() === 0) return explain("The run is at its start, and has reached nothing else: run it first.");

  const texts = signal({ begin: entry(0, furthest.peek()), end: entry(furthest.peek(), furthest.peek()), speed: "1" });
  const wrong = signal({});
  const problem = signal(null);
  const made = signal(null); // the number of pictures; null while none is being made
  const leaving = new AbortController();

  const put = (name) => (event) => {
    texts.value = { ...texts.peek(), [name]: event.currentTarget.value };
    wrong.value = {};
    problem.value = null;
  };

  const Time = ({ name, label, first = false }) => html`<label class="field">
      <span>${label}<span class="quiet">${timeUnit(furthest.value)}</span></span>
      <input inputmode="decimal" data-first=${first} disabled=${made.value !== null} aria-invalid=${Boolean(wrong.value[name])} aria-describedby="video-${name}" value=${texts.value[name]} onInput=${put(name)} />
    </label>
    <${Problem} id="video-${name}" text=${wrong.value[name]} />`;

  function Summary() {
    if (Object.keys(problemsOf(texts.value, furthest.value)).length) return html`<p class="quiet">No video yet: see the times.</p>`;
    const count = countOf(stretchOf(texts.value));
    const { width, height } = sizeNow() ?? size;
    return html`<p class="quiet number">${counted(count, "picture")}, ${timeText(count / RATE)} of video, ${width} × ${height} pixels, ${RATE} pictures a second</p>`;
  }

  function Progress() {
    const count = countOf(stretchOf(texts.value));
    return html`<progress aria-label="Pictures made" max=${count} value=${made.value}></progress>
      <p class="quiet" role="status"><span class="number">${made.value} of ${count}</span> pictures. It goes on only while this page is visible.</p>`;
  }

  const Body = () => html`<div class="video">
    <p class="quiet">The video shows a part of the run, with the camera and overlays of the 3D view now. While it is made, the run goes through this part picture by picture; then it returns to the present moment.</p>
    <${Time} name="begin" label="From" first=${true} />
    <${Time} name="end" label="To" />
    <label class="field">
      Speed
      <select disabled=${made.value !== null} onChange=${put("speed")}>
        ${SPEEDS.map(([text, speed]) => html`<option key=${text} value=${String(speed)} selected=${String(speed) === texts.value.speed}>${text}</option>`)}
      </select>
    </label>
    ${made.value === null ? html`<${Summary} />` : html`<${Progress} />`}
    <${Problem} text=${problem.value} />
  </div>`;

  async function check() {
    problem.value = null;
    wrong.value = problemsOf(texts.peek(), furthest.peek());
    if (Object.keys(wrong.peek()).length) return false;
    made.value = 0;
    const stretch = stretchOf(texts.peek());
    const name = pictureName(session.peek(), `${seconds(stretch.begin)} to ${seconds(stretch.end)}`);
    try {
      saveFile(`${name}.webm`, await makeVideo(stretch, leaving.signal, (count) => (made.value = count)));
      return true;
    } catch (error) {
      problem.value = `There is no video: ${error.message}`;
      return false;
    } finally {
      made.value = null;
    }
  }

  const actions = [{ text: "Make the video", kind: "primary", busy: "making it …" }];
  await dialog({ title: TITLE, body: html`<${Body} />`, actions, check });
  leaving.abort();
}
