import { newCap } from "../../../static/editor/geometry/caps.js";
import { newShape } from "../../../static/editor/geometry/shapes.js";

/** @typedef {import("../../../static/editor/geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../../static/editor/protocol.js").Prediction} Prediction */
/** @typedef {import("./chances.js").chances} Chances */

export const SQUARE = [0, 0, 100, 0, 100, 100, 0, 100];

/** A cap that shows this outline. @type {(...visible: number[][]) => import("../../../static/editor/protocol.js").Cap} */
export function capOf(...visible) {
  return newCap({ visible });
}

/** @type {(uid: string, ...visible: number[][]) => Shape} */
export function shapeOf(uid, ...visible) {
  return newShape(uid, capOf(...visible));
}

/** A triangle whose right angle is at (x, 0). @type {(x: number) => number[]} */
export function triangle(x) {
  return [x, 0, x + 9, 0, x, 9];
}

/** @type {(id: number, visible?: number[][]) => Prediction} */
export function prediction(id, visible = [SQUARE]) {
  const fields = { run: 1, image: 1, score: 0.9, quality: null, category: "mushroom", whole: null, centre: null, extra: {} };
  return { id, visible, ...fields };
}

/**
 * A polygon with dents, which crosses itself nowhere.
 *
 * @param {ReturnType<Chances>} chances
 * @param {{x: number, y: number, radius: number, count: number}} how
 * @returns {number[]}
 */
export function star({ between }, { x, y, radius, count }) {
  return Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count).flatMap((angle) => {
    const reach = radius * between(0.6, 1);
    return [x + reach * Math.cos(angle), y + reach * Math.sin(angle)];
  });
}
