/**
 * The worker that paints whole pictures of the caps, so that a bed of thousands never holds up the
 * pointer. It keeps a copy of the shapes and is told what changed.
 *
 * @module
 */

import { visibleBounds } from "../geometry/view.js";
import { paint } from "./paint.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("./paint.js").Visible} Visible */

/**
 * @typedef {Object} Order
 * @property {number} id
 * @property {Shape[]} fresh  shapes that are new or changed
 * @property {string[]} gone
 * @property {string[]} lifted  not to be painted
 * @property {string[]} selected
 * @property {Visible} visible
 * @property {import("./colouring.js").Colouring} colouring
 * @property {number} crowd
 * @property {View} view
 * @property {number} width  CSS pixels
 * @property {number} height
 * @property {number} ratio
 */

/** @type {Map<string, Shape>} */
const shapes = new Map();

/** @type {(order: Order) => ImageBitmap} */
function carryOut({ fresh, gone, lifted, selected, visible, colouring, crowd, view, width, height, ratio }) {
  for (const uid of gone) shapes.delete(uid);
  for (const shape of fresh) shapes.set(shape.uid, shape);
  const canvas = new OffscreenCanvas(Math.round(width * ratio), Math.round(height * ratio));
  const context = canvas.getContext("2d");
  if (!context) throw new Error("This browser cannot draw on a canvas.");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  const away = new Set(lifted);
  const picture = {
    shapes: [...shapes.values()].filter(({ uid }) => !away.has(uid)),
    visible,
    colouring,
    crowd,
    selected: new Set(selected),
  };
  paint(context, view, visibleBounds(view, { width, height }), picture);
  return canvas.transferToImageBitmap();
}

self.addEventListener("message", ({ data }) => {
  const bitmap = carryOut(data);
  self.postMessage({ id: data.id, bitmap }, { transfer: [bitmap] });
});
