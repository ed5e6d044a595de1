/**
 * The items that the layers let one see, found by place.
 *
 * @module
 */

import { allAround, pick, withRimNear } from "../geometry/hit.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Point} Point */

export class Sight {
  #items;
  #layers;

  /**
   * @param {import("./items.js").Items} items
   * @param {import("./layers.js").Layers} layers
   */
  constructor(items, layers) {
    this.#items = items;
    this.#layers = layers;
  }

  /** @type {(uid: string) => boolean} */
  shows(uid) {
    const shape = this.#items.get(uid);
    return shape !== null && this.#layers.show(shape);
  }

  get all() {
    return this.#seenOf(this.#items.all);
  }

  /** Those of which anything may be drawn in the rectangle. @type {(bounds: Bounds) => Shape[]} */
  near(bounds) {
    return this.#seenOf(this.#items.near(bounds));
  }

  /** The one at a point, else the one whose outline is nearest within `reach` pixels. @type {(point: Point, reach: number) => Shape | null} */
  at(point, reach) {
    return pick([...this.near(around(point, reach)), ...this.#besides], point, reach);
  }

  /** Those whose outline passes within `reach` of a point, the nearest first. @type {(point: Point, reach: number) => Shape[]} */
  rimsNear(point, reach) {
    return withRimNear(this.near(around(point, reach)), point, reach);
  }

  /** Those that a point lies in, the one that is meant first. @type {(point: Point) => Shape[]} */
  allAt(point) {
    return allAround([...this.near(around(point, 0)), ...this.#besides], point);
  }

  /** What a reviewer can pick although it is not drawn with the caps. */
  get #besides() {
    return this.#layers.allHidden ? [] : this.#items.besides;
  }

  /** @type {(shapes: Shape[]) => Shape[]} */
  #seenOf(shapes) {
    return this.#layers.allHidden ? [] : shapes.filter((shape) => this.#layers.show(shape));
  }
}

/** @type {(point: Point, reach: number) => Bounds} */
function around([x, y], reach) {
  return { x0: x - reach, y0: y - reach, x1: x + reach, y1: y + reach };
}
