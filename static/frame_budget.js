// Limits how often the page draws while the run goes as fast as possible: if drawing is slow, for example without a graphics card, all
// drawing pauses after each picture, because the run needs the processor too.

const SMOOTH = 40; // a picture that takes at most this long [ms] needs no pause
const SHARE = 1 / 6; // the maximum share of time for slower pictures

export class FrameBudget {
  /** Whether the run goes as fast as possible. */
  hurried = false;
  #begun = null; // the start of the current picture
  #open = false; // whether more drawing may join that picture
  #until = 0;

  /** @param ask The `requestAnimationFrame` that calls back when the browser is ready for another picture. */
  constructor(ask = requestAnimationFrame.bind(globalThis)) {
    this.ask = ask;
  }

  /** Called at each drawing: at the start of a picture, measures its cost by the time when the next but one could start. */
  drawing() {
    if (!this.hurried || this.#begun !== null) return;
    this.#begun = performance.now();
    this.#open = true;
    this.ask(() => {
      setTimeout(() => (this.#open = false)); // after all parts were asked to draw, including frames in the page
      this.ask(() => this.#done());
    });
  }

  #done() {
    const cost = performance.now() - this.#begun;
    this.#until = cost > SMOOTH ? this.#begun + cost / SHARE : 0;
    this.#begun = null;
    this.#open = false;
  }

  /** Returns how long to pause [ms], or at least until the next call; 0 if drawing is allowed now. */
  get left() {
    if (!this.hurried || document.hidden || this.#open) return 0;
    return this.#begun === null ? Math.max(0, this.#until - performance.now()) : SMOOTH;
  }
}

/** The instance shared by this page and its 3D view: simultaneous drawings count as one picture. */
export const frameBudget = new FrameBudget();
