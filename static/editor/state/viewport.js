/**
 * The part of the photo that is on screen, and how large. Every image is found again as it was left.
 *
 * @module
 */

import { contains, overlap } from "../geometry/bounds.js";
import {
  centred,
  closeUp,
  onDevicePixels,
  panned,
  revealing,
  toImage,
  toScreen,
  viewOf,
  visibleBounds,
  zoomed,
} from "../geometry/view.js";

/** @typedef {import("../protocol.js").Image} Image */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */

/**
 * What is looked at, whatever the size of the window: null for the whole photo, else the point in the middle.
 *
 * @typedef {{middle: Point, scale: number} | null} Look
 */

export class Viewport {
  /** @type {View} */
  view = { scale: 1, x: 0, y: 0 };
  /** CSS pixels. @type {Size} */
  size = { width: 0, height: 0 };
  /** The whole photo is shown, and stays so in a window of another size. */
  #showsAll = true;
  /** @type {Image | null} */
  #image = null;
  /** How images were left, by id. @type {Map<number, Look>} */
  #looks = new Map();
  #moved;

  /** @param {(how: {led: boolean}) => void} moved  another part of the photo is to be seen; `led` by the pointer, which stays where it is on the photo */
  constructor(moved) {
    this.#moved = moved;
  }

  /** @returns {Look} */
  get look() {
    if (this.#showsAll) return null;
    const { width, height } = this.size;
    return { middle: toImage(this.view, width / 2, height / 2), scale: this.view.scale };
  }

  /** How an image is to be found when it is opened for the first time. @type {(image: number, look: Look) => void} */
  expect(image, look) {
    this.#looks.set(image, look);
  }

  /** Shows an image, which may be the same one anew. @type {(image: Image) => void} */
  open(image) {
    if (this.#image?.id === image.id) return;
    if (this.#image) this.#looks.set(this.#image.id, this.look);
    this.#image = image;
    this.#lookAt(this.#looks.get(image.id) ?? null);
  }

  /**
   * What was in the middle stays there, and a photo that was wholly on screen stays so.
   *
   * @type {(size: Size) => void}
   */
  resize({ width, height }) {
    const { look } = this;
    const whole = this.#isWholeOnScreen();
    this.size = { width, height };
    this.#lookAt(look);
    if (whole && !this.#isWholeOnScreen()) this.showAll();
  }

  #isWholeOnScreen() {
    return contains(visibleBounds(this.view, this.size), this.#bounds);
  }

  /** @type {(look: Look) => void} */
  #lookAt(look) {
    if (!look) return this.showAll();
    const { middle, scale } = look;
    const [x, y] = toScreen({ scale, x: 0, y: 0 }, ...middle);
    this.#show({ scale, x: this.size.width / 2 - x, y: this.size.height / 2 - y });
  }

  /** @type {(view: View, how?: {all?: boolean, led?: boolean}) => void} */
  #show(view, { all = false, led = false } = {}) {
    this.#showsAll = all;
    this.view = onDevicePixels(view, globalThis.devicePixelRatio ?? 1);
    this.#moved({ led });
  }

  /** @type {(dx: number, dy: number) => void} */
  panBy(dx, dy) {
    this.#show(panned(this.view, dx, dy), { led: true });
  }

  /** Zooms where the pointer is. @type {(x: number, y: number, factor: number) => void} */
  zoomAt(x, y, factor) {
    this.#show(this.#zoomed(x, y, factor), { led: true });
  }

  /** Zooms in the middle of the window. @type {(factor: number) => void} */
  zoomBy(factor) {
    this.#show(this.#zoomed(this.size.width / 2, this.size.height / 2, factor));
  }

  /** @type {(x: number, y: number, factor: number) => View} */
  #zoomed(x, y, factor) {
    return zoomed(this.view, { x, y, factor, smallest: this.#viewOfAll().scale / 4 });
  }

  /** Shows the whole photo. */
  showAll() {
    this.#show(this.#viewOfAll(), { all: true });
  }

  #viewOfAll() {
    return viewOf(this.#bounds, this.size, 12);
  }

  /** Of the photo. @returns {Bounds} */
  get #bounds() {
    const { width, height } = this.#image ?? { width: 1, height: 1 };
    return { x0: 0, y0: 0, x1: width, y1: height };
  }

  /** Brings a part of the photo into view. @type {(bounds: Bounds, how: {close: boolean}) => void} */
  reveal(bounds, { close }) {
    const { x, y, scale } = this.view;
    const view = close ? closeUp(this.view, bounds, this.size) : revealing(this.view, bounds, this.size);
    // Where nothing moves, a whole photo stays whole.
    if (view.scale !== scale || view.x !== x || view.y !== y) this.#show(view);
  }

  /** Brings a part of the photo to where one looks. @type {(bounds: Bounds) => void} */
  centre(bounds) {
    const view = centred(revealing(this.view, bounds, this.size), bounds, this.size);
    if (view.scale !== this.view.scale || view.x !== this.view.x || view.y !== this.view.y) this.#show(view);
  }

  /** Whether anything of a part of the photo is on screen. @type {(bounds: Bounds) => boolean} */
  shows(bounds) {
    return overlap(bounds, visibleBounds(this.view, this.size));
  }
}
