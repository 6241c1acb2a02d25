// How often something is drawn while the run goes as fast as it can: where drawing takes long, as without a graphics card, it rests for
// a while after each picture, for the run needs the processor, too.

const SMOOTH = 40; // a picture that takes no longer than this [ms] is free
const SHARE = 1 / 4; // of the time may go into others

export class Rest {
  /** Whether the run goes as fast as it can. */
  hurried = false;
  #cost = 0;
  #until = 0;

  /** @param ask The `requestAnimationFrame` that tells when the browser is ready for another picture. */
  constructor(ask = requestAnimationFrame.bind(globalThis)) {
    this.ask = ask;
  }

  /** Is called as a picture is begun: measures what it costs, by when the one after it could be begun. */
  drawing() {
    const begin = performance.now();
    this.ask(() =>
      this.ask(() => {
        // The browser may begin two or three before it waits for the first.
        this.#cost = Math.max(performance.now() - begin, this.#cost / 2);
        this.#until = this.#cost > SMOOTH ? begin + this.#cost / SHARE : 0;
      }),
    );
  }

  /** How long it is to rest from now on [ms]; 0 where the next picture may be drawn. */
  get left() {
    return this.hurried ? Math.max(0, this.#until - performance.now()) : 0;
  }
}
