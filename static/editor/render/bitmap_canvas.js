/**
 * A canvas that is drawn off screen and shown as a bitmap. A browser that composes in software copies every
 * canvas in sight for each frame, drawn on or not; a bitmap it copies once.
 *
 * @module
 */

/** @typedef {{width: number, height: number, ratio: number}} Extent  CSS pixels, and device pixels in one of them */

export class BitmapCanvas {
  /** On screen. */
  canvas = document.createElement("canvas");
  #screen;
  /** Off screen. */
  #context = offscreenContext();
  /** @type {Extent} */
  #extent = { width: 1, height: 1, ratio: 1 };
  /** Something is drawn that is not shown yet. */
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
    this.#forgetBitmap();
    this.#fresh = true;
    return this.#context;
  }

  /** A canvas is empty once its bitmap is shown. @type {(picture: CanvasImageSource) => void} */
  #copy(picture) {
    this.#empty();
    this.#context.save();
    this.#context.resetTransform();
    this.#context.drawImage(picture, 0, 0);
    this.#context.restore();
  }

  /** Starts an empty drawing; the screen keeps the old one until `show`. @type {(extent: Extent) => void} */
  clear(extent) {
    this.#forgetBitmap();
    this.#extent = extent;
    this.#fresh = true;
    this.#empty();
  }

  #empty() {
    const { width, height, ratio } = this.#extent;
    const { canvas } = this.#context;
    canvas.width = Math.round(width * ratio);
    canvas.height = Math.round(height * ratio);
    this.#context.setTransform(ratio, 0, 0, ratio, 0, 0);
  }

  /** Takes a picture drawn elsewhere; it belongs to the canvas from now on. @type {(bitmap: ImageBitmap, extent: Extent) => void} */
  put(bitmap, extent) {
    this.#forgetBitmap();
    this.#extent = extent;
    this.#bitmap = bitmap;
    this.#fresh = true;
  }

  #forgetBitmap() {
    this.#bitmap?.close();
    this.#bitmap = null;
  }

  /** Brings to the screen what has been drawn since the last time. */
  show() {
    if (!this.#fresh) return;
    this.#fresh = false;
    const bitmap = this.#bitmap ?? this.#context.canvas.transferToImageBitmap();
    this.#bitmap = null;
    if (this.canvas.width !== bitmap.width) this.canvas.width = bitmap.width;
    if (this.canvas.height !== bitmap.height) this.canvas.height = bitmap.height;
    this.#screen.transferFromImageBitmap(bitmap);
    this.canvas.style.width = `${this.#extent.width}px`;
    this.canvas.style.height = `${this.#extent.height}px`;
  }
}

function offscreenContext() {
  const context = new OffscreenCanvas(1, 1).getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  return context;
}
