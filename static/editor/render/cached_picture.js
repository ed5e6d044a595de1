/**
 * A picture that outlives the frame it was drawn in. It is drawn with a margin around the viewport and then
 * only moved (and, while zooming, stretched) by the compositor, until a fresh one is ready to take its
 * place. While it is being zoomed and still fills the viewport, none is made.
 *
 * @module
 */

import { joined, overlap } from "../geometry/bounds.js";
import { toScreen, visibleBounds } from "../geometry/view.js";
import { BitmapCanvas } from "./bitmap_canvas.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {{view: View, width: number, height: number, ratio: number}} Extent  what a picture is to show, CSS pixels */
/** @typedef {OffscreenCanvasRenderingContext2D} Context */

/**
 * @typedef {Object} Painter
 * @property {(context: Context, view: View, region: Bounds) => void} paint  at once
 * @property {(extent: Extent) => Promise<ImageBitmap>} [order]  elsewhere; then `paint` is for repairs only
 * @property {() => void} ready  a better picture has come, or can be made now: show it again
 */

const MARGIN = 96;
const REST_MS = 80;
const MOST_STRETCH = 2;

export class CachedPicture {
  visible = true;
  #canvas;
  /** How the picture was drawn. @type {View | null} */
  #drawn = null;
  /** @type {Size} */
  #size = { width: 0, height: 0 };
  #ratio = 1;
  #stale = true;
  /** The order being carried out, and what has changed since. @type {{repairs: Bounds[]} | null} */
  #job = null;
  /** What was shown last. @type {View | null} */
  #shown = null;
  #resting = 0;
  #painter;

  /**
   * @param {HTMLElement} host
   * @param {Painter} painter
   */
  constructor(host, painter) {
    this.#painter = painter;
    this.#canvas = new BitmapCanvas(host);
  }

  /** The picture is of something else now; the old one stays until the new one is there. */
  discard() {
    this.#stale = true;
    this.#job = null;
  }

  /** Nothing is to be seen until the next picture is there. */
  blank() {
    this.discard();
    this.#drawn = null;
  }

  /** @type {(filter: string) => void} */
  tint(filter) {
    this.#canvas.canvas.style.filter = filter;
  }

  /**
   * Shows the picture as `view` wants it.
   *
   * @param {View} view
   * @param {Size} size
   * @param {number} ratio device pixels per CSS pixel
   * @returns {boolean} whether the picture is up to date and sharp
   */
  show(view, size, ratio) {
    if (size.width !== this.#size.width || size.height !== this.#size.height || ratio !== this.#ratio) {
      this.#size = size;
      this.#ratio = ratio;
      this.discard();
    }
    const good = !this.#stale && this.#drawn !== null && covers(this.#drawn, view);
    if (!good && !this.#mayRest(view)) this.#renew(view);
    this.#shown = view;
    this.#place(view);
    return good || !this.#painter.order;
  }

  /** Whether a stretched picture will do until the view has come to rest. @type {(view: View) => boolean} */
  #mayRest(view) {
    clearTimeout(this.#resting);
    const drawn = this.#drawn;
    if (this.#stale || !drawn || view === this.#shown || !fills(drawn, view, this.#size)) return false;
    this.#resting = window.setTimeout(() => this.#painter.ready(), REST_MS);
    return true;
  }

  /** @type {(view: View) => void} */
  #renew(view) {
    const { order, paint } = this.#painter;
    const extent = { view: ownView(view), ...ownSize(this.#size), ratio: this.#ratio };
    if (!order) {
      this.#clear(view);
      paint(this.#canvas.context, extent.view, visibleBounds(extent.view, extent));
    } else if (!this.#job) {
      /** @type {{repairs: Bounds[]}} */
      const job = { repairs: [] };
      this.#job = job;
      void order(extent).then((bitmap) => this.#take(job, view, bitmap));
    }
  }

  /** @type {(job: {repairs: Bounds[]}, view: View, bitmap: ImageBitmap) => void} */
  #take(job, view, bitmap) {
    if (this.#job === job) {
      this.#job = null;
      this.#clear(view);
      this.#canvas.put(bitmap);
      this.repair(job.repairs);
      this.#painter.ready();
    } else bitmap.close();
  }

  /** @type {(view: View) => void} */
  #clear(view) {
    this.#canvas.clear(ownSize(this.#size), this.#ratio);
    this.#drawn = view;
    this.#stale = false;
  }

  /** @type {(view: View) => void} */
  #place(view) {
    const { canvas } = this.#canvas;
    const drawn = this.#drawn;
    canvas.hidden = !drawn || !this.visible;
    if (!drawn) return;
    this.#canvas.show();
    const stretch = view.scale / drawn.scale;
    const x = view.x - (drawn.x + MARGIN) * stretch;
    const y = view.y - (drawn.y + MARGIN) * stretch;
    const transform = `translate(${x}px, ${y}px)${stretch === 1 ? "" : ` scale(${stretch})`}`;
    if (canvas.style.transform !== transform) canvas.style.transform = transform;
  }

  /**
   * Paints anew what lies in these rectangles (image pixels) and leaves the rest as it is.
   *
   * @param {Bounds[]} rects
   */
  repair(rects) {
    this.#job?.repairs.push(...rects);
    const view = this.#drawn;
    if (!view || this.#stale) return;
    for (const rect of mergedRects(rects)) this.#repairOne(this.#canvas.context, ownView(view), rect);
  }

  /** @type {(context: Context, view: View, rect: Bounds) => void} */
  #repairOne(context, view, rect) {
    const { width, height } = ownSize(this.#size);
    const [left, top] = toScreen(view, rect.x0, rect.y0).map((value) => Math.max(0, Math.floor(value) - 4));
    const [x1, y1] = toScreen(view, rect.x1, rect.y1);
    const size = {
      width: Math.min(width, Math.ceil(x1) + 4) - left,
      height: Math.min(height, Math.ceil(y1) + 4) - top,
    };
    if (size.width <= 0 || size.height <= 0) return;
    context.save();
    context.beginPath();
    context.rect(left, top, size.width, size.height);
    context.clip();
    context.clearRect(left, top, size.width, size.height);
    this.#painter.paint(context, view, visibleBounds({ ...view, x: view.x - left, y: view.y - top }, size));
    context.restore();
  }
}

/** @type {(size: Size) => Size} */
function ownSize({ width, height }) {
  return { width: width + 2 * MARGIN, height: height + 2 * MARGIN };
}

/** The view of the picture's own pixels, whose origin lies in the margin. @type {(view: View) => View} */
function ownView(view) {
  return { ...view, x: view.x + MARGIN, y: view.y + MARGIN };
}

/** @type {(drawn: View, wanted: View) => boolean} */
function covers(drawn, wanted) {
  const close = Math.abs(drawn.x - wanted.x) <= MARGIN && Math.abs(drawn.y - wanted.y) <= MARGIN;
  return close && drawn.scale === wanted.scale;
}

/** Whether the picture, stretched but not much, leaves nothing of the viewport bare. @type {(drawn: View, wanted: View, size: Size) => boolean} */
function fills(drawn, wanted, { width, height }) {
  const stretch = wanted.scale / drawn.scale;
  if (stretch === 1 || stretch > MOST_STRETCH) return false;
  const x = wanted.x - (drawn.x + MARGIN) * stretch;
  const y = wanted.y - (drawn.y + MARGIN) * stretch;
  const own = ownSize({ width, height });
  return x <= 0 && y <= 0 && x + own.width * stretch >= width && y + own.height * stretch >= height;
}

/** Overlapping rectangles as one. @type {(rects: Bounds[]) => Bounds[]} */
function mergedRects(rects) {
  /** @type {Bounds[]} */
  let merged = [];
  for (const rect of rects) {
    const touching = merged.filter((other) => overlap(other, rect));
    merged = [...merged.filter((other) => !overlap(other, rect)), touching.reduce(joined, rect)];
  }
  return merged;
}
