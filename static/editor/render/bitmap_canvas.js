/**
 * A canvas that is drawn off screen and shown as a bitmap. A browser that composes in software copies every
 * canvas in sight for each frame, drawn on or not; a bitmap it copies once.
 *
 * @module
 */

/** @typedef {import("../geometry/view.js").Size} Size */

export class BitmapCanvas {
  /** On screen. */
  canvas = document.createElement("canvas");
  #screen;
  /** Off screen. */
  #context = offscreenContext();
  /** @type {Size} */
  #size = { width: 0, height: 0 };
  /** Something is drawn off screen that is not shown yet. */
  #fresh = false;
  /** Drawn elsewhere, to be shown as it is. @type {ImageBitmap | null} */
  #bitmap = null;

  /** @param {HTMLElement} host */
  constructor(host) {
    const screen = this.canvas.getContext("bitmaprenderer");
    if (!screen) throw new Error("This browser cannot show a bitmap.");
    this.#screen = screen;
    this.canvas.hidden = true;
    host.append(this.canvas);
  }

  /** To draw on what is there; `show` brings it to the screen. */
  get context() {
    if (this.#bitmap) this.#copy(this.#bitmap);
    else if (!this.#fresh) this.#copy(this.canvas);
    this.#bitmap?.close();
    this.#bitmap = null;
    this.#fresh = true;
    return this.#context;
  }

  /** A canvas is empty once its bitmap is shown. @type {(picture: CanvasImageSource) => void} */
  #copy(picture) {
    this.#context.save();
    this.#context.resetTransform();
    this.#context.drawImage(picture, 0, 0);
    this.#context.restore();
  }

  /**
   * Starts an empty drawing; the screen keeps the old one until `show`.
   *
   * @param {Size} size  CSS pixels
   * @param {number} ratio  device pixels per CSS pixel
   */
  clear(size, ratio) {
    const { canvas } = this.#context;
    canvas.width = Math.round(size.width * ratio);
    canvas.height = Math.round(size.height * ratio);
    this.#size = size;
    this.#fresh = true;
    this.#bitmap?.close();
    this.#bitmap = null;
    this.#context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  /** Takes a picture drawn elsewhere, as large as the canvas; it belongs to the canvas from now on. @type {(bitmap: ImageBitmap) => void} */
  put(bitmap) {
    this.#bitmap = bitmap;
  }

  /** Brings to the screen what has been drawn since the last time. */
  show() {
    if (!this.#fresh) return;
    this.#fresh = false;
    const { canvas } = this.#context;
    if (this.canvas.width !== canvas.width) this.canvas.width = canvas.width;
    if (this.canvas.height !== canvas.height) this.canvas.height = canvas.height;
    this.#screen.transferFromImageBitmap(this.#bitmap ?? canvas.transferToImageBitmap());
    this.#bitmap = null;
    this.canvas.style.width = `${this.#size.width}px`;
    this.canvas.style.height = `${this.#size.height}px`;
  }
}

function offscreenContext() {
  const context = new OffscreenCanvas(1, 1).getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  return context;
}
