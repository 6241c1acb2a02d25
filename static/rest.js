// How often something is drawn while the run goes as fast as it can: where drawing takes long, as without a graphics card, it rests for
// a while after each picture, for the run needs the processor, too.

const SMOOTH = 40; // a picture that takes no longer than this [ms] is free
const SHARE = 1 / 6; // of the time may go into others

export class Rest {
  /** Whether the run goes as fast as it can. */
  hurried = false;
  #begun = null; // when the picture was begun that is not done yet
  #until = 0;

  /** @param ask The `requestAnimationFrame` that tells when the browser is ready for another picture. */
  constructor(ask = requestAnimationFrame.bind(globalThis)) {
    this.ask = ask;
  }

  /** Is called as a picture is begun: measures what it costs, by when the one after the next could be begun. */
  drawing() {
    if (!this.hurried || this.#begun !== null) return;
    this.#begun = performance.now();
    this.ask(() => this.ask(() => this.#done()));
  }

  #done() {
    const cost = performance.now() - this.#begun;
    this.#until = cost > SMOOTH ? this.#begun + cost / SHARE : 0;
    this.#begun = null;
  }

  /** For how long it is to rest [ms], or at least until it is asked again; 0 where the next picture may be drawn. */
  get left() {
    if (!this.hurried || document.hidden) return 0;
    return this.#begun === null ? Math.max(0, this.#until - performance.now()) : SMOOTH;
  }
}
