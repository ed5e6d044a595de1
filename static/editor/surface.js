/**
 * A picture of the image that outlives the frame it was drawn in. It is drawn with a margin around the
 * viewport and then only moved (and, while zooming, stretched) by the compositor; a fresh picture is
 * prepared a slice of time at a time and swapped in when it is complete.
 *
 * @module
 */

import { overlap, toScreen, visibleBounds } from "./view.js";

/** @typedef {import("./view.js").Bounds} Bounds */
/** @typedef {import("./view.js").Size} Size */
/** @typedef {import("./view.js").View} View */
/** @typedef {(context: CanvasRenderingContext2D, view: View, region: Bounds) => Generator<void>} Painter */
/** @typedef {{canvas: HTMLCanvasElement, context: CanvasRenderingContext2D, view: View | null}} Sheet */

const MARGIN = 96;

export class Surface {
  /** @type {Sheet} */
  #front;
  /** @type {Sheet} */
  #back;
  /** @type {Generator<void> | null} */
  #work = null;
  /** @type {Size} */
  #size = { width: 0, height: 0 };
  #ratio = 1;
  #stale = true;
  #paint;
  visible = true;

  /**
   * @param {HTMLElement} host
   * @param {Painter} paint
   */
  constructor(host, paint) {
    this.#paint = paint;
    this.#front = sheet(host);
    this.#back = sheet(host);
  }

  /** The picture is of something else now. */
  discard() {
    this.#stale = true;
    this.#work = null;
  }

  /** Nothing is to be seen until the next picture is complete. */
  blank() {
    this.discard();
    this.#front.view = null;
  }

  /** @type {(filter: string) => void} */
  tint(filter) {
    this.#front.canvas.style.filter = filter;
    this.#back.canvas.style.filter = filter;
  }

  /**
   * Shows the picture as `view` wants it, drawing for at most `budget` ms.
   *
   * @param {View} view
   * @param {Size} size
   * @param {number} ratio device pixels per CSS pixel
   * @param {number} budget
   * @returns {boolean} whether the picture is complete and sharp
   */
  show(view, size, ratio, budget) {
    if (size.width !== this.#size.width || size.height !== this.#size.height || ratio !== this.#ratio) {
      this.#size = size;
      this.#ratio = ratio;
      this.discard();
    }
    if (!this.#stale && this.#front.view && covers(this.#front.view, view)) this.#work = null;
    else this.#draw(view, budget);
    this.#place(view);
    return this.#work === null;
  }

  /** @type {(view: View, budget: number) => void} */
  #draw(view, budget) {
    if (!this.#work || !this.#back.view || !covers(this.#back.view, view)) this.#begin(view);
    const until = performance.now() + budget;
    while (this.#work && performance.now() < until) {
      if (this.#work.next().done) this.#finish();
    }
  }

  /** @type {(view: View) => void} */
  #begin(view) {
    const back = this.#back;
    const { width, height } = sheetSize(this.#size);
    back.canvas.width = Math.round(width * this.#ratio);
    back.canvas.height = Math.round(height * this.#ratio);
    back.canvas.style.width = `${width}px`;
    back.canvas.style.height = `${height}px`;
    back.view = view;
    const own = ownView(view);
    back.context.setTransform(this.#ratio, 0, 0, this.#ratio, 0, 0);
    this.#work = this.#paint(back.context, own, visibleBounds(own, { width, height }));
  }

  #finish() {
    [this.#front, this.#back] = [this.#back, this.#front];
    this.#back.canvas.hidden = true;
    this.#work = null;
    this.#stale = false;
  }

  /** @type {(view: View) => void} */
  #place(view) {
    const drawn = this.#front.view;
    this.#front.canvas.hidden = !drawn || !this.visible;
    if (!drawn) return;
    const stretch = view.scale / drawn.scale;
    const x = view.x - (drawn.x + MARGIN) * stretch;
    const y = view.y - (drawn.y + MARGIN) * stretch;
    const transform = `translate(${x}px, ${y}px)${stretch === 1 ? "" : ` scale(${stretch})`}`;
    if (this.#front.canvas.style.transform !== transform) this.#front.canvas.style.transform = transform;
  }

  /**
   * Paints anew what lies in these rectangles (image pixels) and leaves the rest as it is.
   *
   * @param {Bounds[]} rects
   */
  repair(rects) {
    if (this.#work) this.discard();
    const { view, context } = this.#front;
    if (!view || this.#stale) return;
    const own = ownView(view);
    for (const rect of mergedRects(rects)) this.#repairOne(context, own, rect);
  }

  /** @type {(context: CanvasRenderingContext2D, view: View, rect: Bounds) => void} */
  #repairOne(context, view, rect) {
    const { width, height } = sheetSize(this.#size);
    const [left, top] = toScreen(view, rect.x0, rect.y0).map((value) => Math.max(0, Math.floor(value) - 4));
    const [x1, y1] = toScreen(view, rect.x1, rect.y1);
    const right = Math.min(width, Math.ceil(x1) + 4);
    const bottom = Math.min(height, Math.ceil(y1) + 4);
    if (right <= left || bottom <= top) return;
    const region = visibleBounds(
      { ...view, x: view.x - left, y: view.y - top },
      { width: right - left, height: bottom - top },
    );
    context.save();
    context.beginPath();
    context.rect(left, top, right - left, bottom - top);
    context.clip();
    context.clearRect(left, top, right - left, bottom - top);
    for (const work = this.#paint(context, view, region); !work.next().done; );
    context.restore();
  }
}

/** @type {(host: HTMLElement) => Sheet} */
function sheet(host) {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  canvas.hidden = true;
  host.append(canvas);
  return { canvas, context, view: null };
}

/** @type {(size: Size) => Size} */
function sheetSize({ width, height }) {
  return { width: width + 2 * MARGIN, height: height + 2 * MARGIN };
}

/** The view of a sheet's own pixels, whose origin lies in the margin. @type {(view: View) => View} */
function ownView(view) {
  return { ...view, x: view.x + MARGIN, y: view.y + MARGIN };
}

/** @type {(drawn: View, wanted: View) => boolean} */
function covers(drawn, wanted) {
  const close = Math.abs(drawn.x - wanted.x) <= MARGIN && Math.abs(drawn.y - wanted.y) <= MARGIN;
  return close && drawn.scale === wanted.scale;
}

/** @type {(rects: Bounds[]) => Bounds[]} */
function mergedRects(rects) {
  /** @type {Bounds[]} */
  const merged = [];
  for (let rect of rects) {
    for (let i = merged.length - 1; i >= 0; i--) {
      if (!overlap(merged[i], rect)) continue;
      const [other] = merged.splice(i, 1);
      rect = {
        x0: Math.min(rect.x0, other.x0),
        y0: Math.min(rect.y0, other.y0),
        x1: Math.max(rect.x1, other.x1),
        y1: Math.max(rect.y1, other.y1),
      };
    }
    merged.push(rect);
  }
  return merged;
}
