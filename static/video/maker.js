// Makes a video of the 3D view, exact in the time of the run: for each picture the run goes to its moment, and the picture is taken when
// the 3D view has drawn that moment, however long it takes.

import { exactTime } from "../parts/units.js";
import { request, sendCommand } from "../server.js";
import { listeners, period, session, state, history } from "../store.js";
import { furthest, requestThere } from "../timeline/seek.js";
import { encoderFor, VideoFile } from "./encoder.js";

export const RATE = 30; // pictures a second
export const LONGEST = 600; // length of a video [s]
const PATIENCE = 30_000; // for the drawing of one moment [ms]
const LONGEST_FRAME = 200; // of this patience; a hidden page draws nothing, and may wait [ms]
const NEAR = 1e-6; // times that differ less are the same [s]

/**
 * @typedef Stretch
 * @property {number} begin A time of the run [s].
 * @property {number} end A later one [s].
 * @property {number} speed Times real time.
 */

/** Returns the number of pictures: the last one shows the end. */
export function countOf({ begin, end, speed }) {
  return Math.floor(((end - begin) / speed) * RATE + 1e-6) + 1;
}

/** Returns the time of the run that a picture shows [s]: that of the nearest tick which the run has reached. */
function timeOf({ begin, end, speed }, number) {
  const tick = period.peek();
  const last = Math.floor(furthest.peek() / tick + 1e-6);
  const ticks = Math.round(Math.min(end, begin + (number * speed) / RATE) / tick);
  return exactTime(Math.min(ticks, last) * tick);
}

/** Returns the window of the 3D view, if it has drawn a scene. */
function scene() {
  const inner = document.querySelector("#scene iframe")?.contentWindow;
  return inner?.scene?.picture ? inner.scene : null;
}

/** Returns the size of a video of the present 3D view [pixels]: what the screen shows, with even numbers; null if there is no view. */
export function sizeNow() {
  const view = document.querySelector("#scene iframe");
  if (!view || !scene()) return null;
  const even = (length) => 2 * Math.floor((length * devicePixelRatio) / 2);
  return { width: even(view.clientWidth), height: even(view.clientHeight) };
}

const nextFrame = () => new Promise(requestAnimationFrame);

/** An error that means that somebody else has taken the run elsewhere. */
function goneElsewhere(text) {
  return Object.assign(new Error(text), { elsewhere: true });
}

class Maker {
  constructor(stretch, stopped) {
    this.stretch = stretch;
    this.stopped = stopped;
    this.history = history.peek();
    this.size = sizeNow();
    this.canvas = Object.assign(document.createElement("canvas"), this.size);
    this.before = state.peek().time;
    this.expected = [this.before, this.before]; // where the run is, and where it goes [s]
    this.isElsewhere = false;
    this.listen = ({ state: now }) => now && this.note(now);
  }

  /** Notes whether somebody else moves the run; what this browser does not hear of in between, the next state shows. */
  note({ time, status }) {
    const isThere = this.expected.some((one) => Math.abs(one - time) < NEAR);
    const repeats = session.peek()?.kind === "program" && status === "running" && time < this.expected[1]; // a program goes by running again
    if (!isThere && !repeats) this.isElsewhere = true;
  }

  /** Throws an Error if the video cannot go on. */
  check() {
    this.stopped.throwIfAborted();
    if (history.peek() !== this.history) throw goneElsewhere("the run was restarted or changed, or another one is shown");
    if (this.isElsewhere) throw goneElsewhere("somebody else moved the run to another time");
    const size = sizeNow();
    if (size === null) throw new Error("the 3D view was closed");
    if (size.width !== this.size.width || size.height !== this.size.height) throw new Error("the 3D view has another size now");
  }

  /** Goes to a time of the run [s]. */
  async go(time) {
    this.check();
    this.expected = [this.expected[1], time];
    try {
      await request({ type: "seek", time });
    } catch (error) {
      await nextFrame();
      this.check(); // a run that was restarted has not been there: the reason is the restart
      throw error;
    }
    while (Math.abs(state.peek().time - time) >= NEAR) {
      await nextFrame(); // a program is still on its way
      this.check();
    }
  }

  /** Draws the moment where the run is on the canvas. */
  async draw() {
    const { time } = state.peek();
    let waited = 0;
    for (;;) {
      const begun = performance.now();
      await nextFrame();
      waited += Math.min(LONGEST_FRAME, performance.now() - begun);
      this.check();
      if (waited > PATIENCE) throw new Error("the 3D view does not draw");
      if (scene().drawnTime() !== time) continue;
      await nextFrame(); // what viser draws with React is there one frame later
      this.check();
      scene().picture(devicePixelRatio, this.canvas);
      if (scene().shown.time === time) return;
    }
  }

  async make(progress) {
    this.check();
    const chosen = await encoderFor(this.size, RATE);
    if (chosen === null) throw new Error("this browser cannot encode pictures of this size");
    const file = new VideoFile(chosen);
    listeners.add(this.listen);
    try {
      const count = countOf(this.stretch);
      let drawn = null;
      for (let number = 0; number < count; number++) {
        const time = timeOf(this.stretch, number);
        if (time !== drawn) {
          await this.go(time);
          await this.draw();
        }
        drawn = time;
        await file.add(this.canvas, number);
        progress(number + 1);
      }
      return await file.finish();
    } finally {
      listeners.delete(this.listen);
      file.close();
    }
  }
}

/**
 * Pauses the run, and makes a video of a stretch of it; afterwards the run is where it was, unless somebody else has taken it elsewhere.
 * Returns it as a Blob, or throws an Error with the reason.
 * @param {Stretch} stretch
 * @param {AbortSignal} stopped Cancels it.
 * @param {(count: number) => void} progress Called with the number of pictures made.
 */
export async function makeVideo(stretch, stopped, progress) {
  await requestThere({ type: "pause" });
  stopped.throwIfAborted();
  const maker = new Maker(stretch, stopped);
  const goBack = () => history.peek() === maker.history && sendCommand({ type: "seek", time: maker.before });
  addEventListener("pagehide", goBack);
  try {
    const made = await maker.make(progress);
    await goBack();
    return made;
  } catch (error) {
    if (!error.elsewhere) await goBack();
    throw error;
  } finally {
    removeEventListener("pagehide", goBack);
  }
}
