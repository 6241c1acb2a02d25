// Draws again after a change: at once for the user's actions, otherwise at a limited rate.

const BETWEEN = 66; // between two drawings while a run goes on [ms]

export class Painter {
  /** @param paint The function that draws. */
  constructor(paint) {
    this.paint = paint;
    this.drawn = 0;
    this.timer = 0;
    this.frame = 0;
  }

  /** Requests a drawing: at the next frame, or `later`, together with other changes until then. */
  ask(later = false) {
    const wait = later ? this.drawn + BETWEEN - performance.now() : 0;
    if (this.frame || (later && this.timer)) return;
    clearTimeout(this.timer);
    if (wait > 0) this.timer = setTimeout(() => this.#next(), wait);
    else this.#next();
  }

  #next() {
    this.timer = 0;
    // A hidden page gets no frames.
    this.frame = requestAnimationFrame(() => {
      this.frame = 0;
      this.drawn = performance.now();
      this.paint();
    });
  }

  stop() {
    clearTimeout(this.timer);
    cancelAnimationFrame(this.frame);
  }
}
