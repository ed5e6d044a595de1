/**
 * A picture that is drawn off screen and shown as a bitmap. A browser that composes in software copies every
 * canvas in sight for each frame, drawn on or not; a bitmap it copies once.
 *
 * @module
 */

/** @typedef {import("./view.js").Size} Size */

export class Sheet {
  /** On screen. */
  canvas = document.createElement("canvas");
  #screen;
  #drawn = drawable();
  #copy = drawable();
  /** @type {Size} */
  #size = { width: 0, height: 0 };
  #fresh = false;

  /** @param {HTMLElement} host */
  constructor(host) {
    const screen = this.canvas.getContext("bitmaprenderer");
    if (!screen) throw new Error("This browser cannot show a bitmap.");
    this.#screen = screen;
    this.canvas.hidden = true;
    host.append(this.canvas);
  }

  /** To draw on; `show` brings it to the screen. */
  get context() {
    this.#fresh = true;
    return this.#drawn;
  }

  /**
   * An empty sheet in the place of the one drawn on so far; the screen keeps that until `show`.
   *
   * @param {Size} size  CSS pixels
   * @param {number} ratio  device pixels per CSS pixel
   */
  cut(size, ratio) {
    this.#size = size;
    for (const { canvas } of [this.#drawn, this.#copy]) {
      canvas.width = Math.round(size.width * ratio);
      canvas.height = Math.round(size.height * ratio);
    }
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  /** Brings to the screen what has been drawn since the last time. */
  show() {
    if (!this.#fresh) return;
    this.#fresh = false;
    const { canvas } = this.#copy;
    this.#copy.drawImage(this.#drawn.canvas, 0, 0);
    this.#screen.transferFromImageBitmap(canvas.transferToImageBitmap());
    this.canvas.style.width = `${this.#size.width}px`;
    this.canvas.style.height = `${this.#size.height}px`;
  }
}

function drawable() {
  const context = new OffscreenCanvas(1, 1).getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  return context;
}
