// Draws again when something has changed: at once where the user does it, else not more often than one sees.

const BETWEEN = 66; // between two drawings while a run goes on [ms]

export class Painter {
  /** @param paint Draws. */
  constructor(paint) {
    this.paint = paint;
    this.drawn = 0;
    this.timer = 0;
    this.frame = 0;
  }

  /** Asks for a drawing: at the next frame, or `later`, with what else changes until then. */
  ask(later = false) {
    const wait = later ? this.drawn + BETWEEN - performance.now() : 0;
    if (this.frame || (later && this.timer)) return;
    clearTimeout(this.timer);
    if (wait > 0) this.timer = setTimeout(() => this.#next(), wait);
    else this.#next();
  }

  #next() {
    this.timer = 0;
    // A page that is not seen gets no frames.
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
