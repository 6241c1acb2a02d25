// Draws the 3D view with all pixels of the screen once it rests. While drawing is slow, viser draws fewer pixels until many
// pictures in a row are fast; but a view that rests is not drawn again.

const REST = 500; // after this time without a picture, the view rests [ms]

export class Sharpness {
  #newest = -Infinity; // when the newest picture was drawn
  #moving = null; // viser's number of pixels per pixel of the page while the picture is drawn with all of them; otherwise null
  #timer = 0;

  /** @param renderer Viser's. @param draw Draws the view once more. @param isBusy Whether the processor is needed for the run. */
  constructor(renderer, draw, isBusy) {
    Object.assign(this, { renderer, draw, isBusy });
  }

  /** Called before each picture. The first one after a rest is still drawn with all pixels: nothing may have changed. */
  before() {
    const now = performance.now();
    const rests = now - this.#newest > REST && !this.isBusy();
    this.#newest = now;
    const ratio = this.renderer.getPixelRatio();
    if (rests && ratio < devicePixelRatio) {
      this.#moving = ratio;
      this.renderer.setPixelRatio(devicePixelRatio);
    } else if (!rests && this.#moving !== null) {
      if (ratio === devicePixelRatio) this.renderer.setPixelRatio(this.#moving); // otherwise viser has set it since
      this.#moving = null;
    }
    clearTimeout(this.#timer);
    if (!rests && this.renderer.getPixelRatio() < devicePixelRatio) this.#timer = setTimeout(() => this.#rest(), REST + 1);
  }

  #rest() {
    if (this.isBusy()) this.#timer = setTimeout(() => this.#rest(), REST);
    else this.draw();
  }
}
