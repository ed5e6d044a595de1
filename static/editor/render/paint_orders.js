/**
 * Orders pictures of the caps from the painting worker.
 *
 * @module
 */

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./paint.js").Picture} Picture */
/** @typedef {import("./paint_worker.js").Order} Order */
/** @typedef {import("./extents.js").Extent} Extent */

export class PaintOrders {
  #worker = new Worker(new URL("./paint_worker.js", import.meta.url), { type: "module" });
  /** What the worker has. @type {Map<string, Shape>} */
  #sent = new Map();
  /** @type {Map<number, (bitmap: ImageBitmap) => void>} */
  #orders = new Map();
  #next = 0;

  constructor() {
    this.#worker.addEventListener("message", ({ data }) => {
      this.#orders.get(data.id)?.(data.bitmap);
      this.#orders.delete(data.id);
    });
  }

  /**
   * @param {Extent} extent
   * @param {Picture & {lifted: Set<string>}} picture  with every shape, lifted ones too
   * @returns {Promise<ImageBitmap>}
   */
  order(extent, { shapes, visible, selected, lifted, colouring = "none", crowd }) {
    const id = this.#next++;
    const fresh = shapes.filter((shape) => this.#sent.get(shape.uid) !== shape);
    const now = new Map(shapes.map((shape) => [shape.uid, shape]));
    const gone = [...this.#sent.keys()].filter((uid) => !now.has(uid));
    this.#sent = now;
    /** @type {Order} */
    const order = {
      id,
      ...extent,
      fresh,
      gone,
      visible,
      colouring,
      crowd,
      lifted: [...lifted],
      selected: [...selected],
    };
    this.#worker.postMessage(order);
    return new Promise((resolve) => this.#orders.set(id, resolve));
  }
}
