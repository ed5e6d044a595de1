/**
 * A picture that outlives the frame it was drawn in. It is drawn with a margin around the viewport and then
 * only moved (and, while zooming, stretched) by the compositor. A fresh one is made between two frames, in
 * time for a movement that goes on as it does, so that no frame waits for one.
 *
 * @module
 */

import { joined, overlap } from "../geometry/bounds.js";
import { toScreen, visibleBounds } from "../geometry/view.js";
import { BitmapCanvas } from "./bitmap_canvas.js";
import { covers, extentOf, goneOn, isOverstretched, isSharp, placeOf } from "./extents.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("./extents.js").Extent} Extent */
/** @typedef {import("./extents.js").Use} Use */
/** @typedef {import("./extents.js").Wanted} Wanted */
/** @typedef {OffscreenCanvasRenderingContext2D} Context */

/**
 * @typedef {Object} Painter
 * @property {(context: Context, view: View, region: Bounds) => void} paint  at once
 * @property {(extent: Extent) => Promise<ImageBitmap>} [order]  elsewhere; then `paint` is for repairs only
 * @property {() => void} ready  a better picture has come, or can be made now: show it again
 */

export class CachedPicture {
  visible = true;
  #canvas;
  /** How the picture was drawn. @type {Extent | null} */
  #drawn = null;
  #stale = true;
  /** The order being carried out, and what has changed since. @type {{repairs: Bounds[]} | null} */
  #job = null;
  /** What was shown last. @type {Wanted | null} */
  #shown = null;
  /** How the picture is to be renewed as soon as the frame is on screen. @type {Use | null} */
  #planned = null;
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
   * Shows the picture as it is wanted.
   *
   * @param {Wanted} wanted
   * @param {{before: View, still: boolean}} movement  of the photo on screen
   * @returns {boolean} whether the picture is up to date and sharp
   */
  show(wanted, movement) {
    if (this.#shown && !isSameWindow(this.#shown, wanted)) this.discard();
    this.#shown = wanted;
    this.#see(wanted, movement);
    this.#place(wanted.view);
    return !this.#stale && this.#drawn !== null && isSharp(this.#drawn, wanted) && covers(this.#drawn, wanted);
  }

  /** Sees to it that there is a picture, now and soon. @type {(wanted: Wanted, movement: {before: View, still: boolean}) => void} */
  #see(wanted, { before, still }) {
    const { view } = wanted;
    const drawn = this.#stale ? null : this.#drawn;
    if (!drawn || !covers(drawn, wanted)) return this.#renew(wanted, "moving");
    const sharp = isSharp(drawn, wanted);
    if (still && !sharp) return this.#renew(wanted, "moving");
    const lasts = covers(drawn, { ...wanted, view: goneOn(before, view) });
    if (sharp) {
      if (!lasts) this.#plan("moving");
    } else if (!lasts || isOverstretched(drawn, view))
      this.#plan(view.scale < before.scale ? "shrinking" : "enlarging");
  }

  /** @type {(use: Use) => void} */
  #plan(use) {
    if (!this.#planned) afterFrame(() => this.#carryOut());
    this.#planned = use;
  }

  #carryOut() {
    const use = this.#planned;
    this.#planned = null;
    if (!use || !this.#shown) return;
    this.#renew(this.#shown, use);
    this.#place(this.#shown.view);
  }

  /** @type {(wanted: Wanted, use: Use) => void} */
  #renew(wanted, use) {
    const { order, paint } = this.#painter;
    const extent = extentOf(wanted, use);
    if (!order) {
      this.#canvas.clear(extent);
      this.#drawn = extent;
      this.#stale = false;
      paint(this.#canvas.context, extent.view, visibleBounds(extent.view, extent));
    } else if (!this.#job) {
      /** @type {{repairs: Bounds[]}} */
      const job = { repairs: [] };
      this.#job = job;
      void order(extent).then((bitmap) => this.#take(job, extent, bitmap));
    }
  }

  /** @type {(job: {repairs: Bounds[]}, extent: Extent, bitmap: ImageBitmap) => void} */
  #take(job, extent, bitmap) {
    if (this.#job !== job) return bitmap.close();
    this.#job = null;
    this.#canvas.put(bitmap, extent);
    this.#drawn = extent;
    this.#stale = false;
    this.repair(job.repairs);
    if (this.#shown) this.#place(this.#shown.view);
    this.#painter.ready();
  }

  /** @type {(view: View) => void} */
  #place(view) {
    const { canvas } = this.#canvas;
    const drawn = this.#drawn;
    canvas.hidden = !drawn || !this.visible;
    if (!drawn) return;
    this.#canvas.show();
    const { x, y, stretch } = placeOf(drawn, view);
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
    const drawn = this.#drawn;
    if (!drawn || this.#stale) return;
    for (const rect of mergedRects(rects)) this.#repairOne(drawn, rect);
  }

  /** @type {(drawn: Extent, rect: Bounds) => void} */
  #repairOne({ view, width, height }, rect) {
    const [left, top] = toScreen(view, rect.x0, rect.y0).map((value) => Math.max(0, Math.floor(value) - 4));
    const [x1, y1] = toScreen(view, rect.x1, rect.y1);
    const size = {
      width: Math.min(width, Math.ceil(x1) + 4) - left,
      height: Math.min(height, Math.ceil(y1) + 4) - top,
    };
    if (size.width <= 0 || size.height <= 0) return;
    const { context } = this.#canvas;
    context.save();
    context.beginPath();
    context.rect(left, top, size.width, size.height);
    context.clip();
    context.clearRect(left, top, size.width, size.height);
    this.#painter.paint(context, view, visibleBounds({ ...view, x: view.x - left, y: view.y - top }, size));
    context.restore();
  }
}

/** @type {(before: Wanted, now: Wanted) => boolean} */
function isSameWindow({ size, ratio }, now) {
  return size.width === now.size.width && size.height === now.size.height && ratio === now.ratio;
}

/** Does something as soon as the frame that is being drawn is on its way to the screen. @type {(task: () => void) => void} */
function afterFrame(task) {
  const { port1, port2 } = new MessageChannel();
  port1.onmessage = () => {
    port1.close();
    task();
  };
  port2.postMessage(null);
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
