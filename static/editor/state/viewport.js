/**
 * The part of the photo that is on screen, and how large. Every image is found again as it was left.
 *
 * @module
 */

import { grown } from "../geometry/bounds.js";
import { viewOf, onDevicePixels, panned, revealing, zoomed } from "../geometry/view.js";

/** @typedef {import("../protocol.js").Image} Image */
/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */

export class Viewport {
  /** @type {View} */
  view = { scale: 1, x: 0, y: 0 };
  /** CSS pixels. @type {Size} */
  size = { width: 0, height: 0 };
  /** @type {Image | null} */
  #image = null;
  /** How images were left, by id. @type {Map<number, View>} */
  #views = new Map();
  #moved;

  /** @param {() => void} moved  another part of the photo is to be seen */
  constructor(moved) {
    this.#moved = moved;
  }

  /** Shows an image, which may be the same one anew. @type {(image: Image) => void} */
  open(image) {
    const same = this.#image?.id === image.id;
    if (this.#image && !same) this.#views.set(this.#image.id, this.view);
    this.#image = image;
    const known = this.#views.get(image.id);
    if (!same && known) this.#show(known);
    else if (!same) this.showAll();
  }

  /** What was in the middle stays there. @type {(size: Size) => void} */
  resize({ width, height }) {
    const first = this.size.width === 0;
    const [dx, dy] = [(width - this.size.width) / 2, (height - this.size.height) / 2];
    this.size = { width, height };
    if (first) this.showAll();
    else this.panBy(dx, dy);
  }

  /** @type {(view: View) => void} */
  #show(view) {
    this.view = onDevicePixels(view, globalThis.devicePixelRatio ?? 1);
    this.#moved();
  }

  /** @type {(dx: number, dy: number) => void} */
  panBy(dx, dy) {
    this.#show(panned(this.view, dx, dy));
  }

  /** @type {(x: number, y: number, factor: number) => void} */
  zoomAt(x, y, factor) {
    this.#show(zoomed(this.view, { x, y, factor, smallest: this.#viewOfAll().scale / 4 }));
  }

  /** Shows the whole photo. */
  showAll() {
    this.#show(this.#viewOfAll());
  }

  #viewOfAll() {
    const { width, height } = this.#image ?? { width: 1, height: 1 };
    return viewOf({ x0: 0, y0: 0, x1: width, y1: height }, this.size, 12);
  }

  /** Brings a part of the photo into view. @type {(bounds: Bounds, how: {close: boolean}) => void} */
  reveal(bounds, { close }) {
    const reach = Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0);
    this.#show(
      close ? viewOf(grown(bounds, reach / 2), this.size, 40) : revealing(this.view, bounds, this.size),
    );
  }
}
