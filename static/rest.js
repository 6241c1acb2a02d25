// How often something is drawn while the run goes as fast as it can: where drawing takes long, as without a graphics card, all that is
// drawn rests for a while after each picture, for the run needs the processor, too.

const SMOOTH = 40; // a picture that takes no longer than this [ms] is free
const SHARE = 1 / 6; // of the time may go into others

export class Rest {
  /** Whether the run goes as fast as it can. */
  hurried = false;
  #begun = null; // when the picture was begun that is not done yet
  #open = false; // whether more may come into that one
  #until = 0;

  /** @param ask The `requestAnimationFrame` that tells when the browser is ready for another picture. */
  constructor(ask = requestAnimationFrame.bind(globalThis)) {
    this.ask = ask;
  }

  /** Is called as something is drawn: where that begins a picture, measures what it costs, by when the one after the next could be begun. */
  drawing() {
    if (!this.hurried || this.#begun !== null) return;
    this.#begun = performance.now();
    this.#open = true;
    this.ask(() => {
      setTimeout(() => (this.#open = false)); // when everybody has been asked to draw, frames in the page, too
      this.ask(() => this.#done());
    });
  }

  #done() {
    const cost = performance.now() - this.#begun;
    this.#until = cost > SMOOTH ? this.#begun + cost / SHARE : 0;
    this.#begun = null;
    this.#open = false;
  }

  /** For how long it is to rest [ms], or at least until it is asked again; 0 where something may be drawn now. */
  get left() {
    if (!this.hurried || document.hidden || this.#open) return 0;
    return this.#begun === null ? Math.max(0, this.#until - performance.now()) : SMOOTH;
  }
}

/** That of this page, and of the 3D view in it: what draws at once is put together once. */
export const rest = new Rest();
