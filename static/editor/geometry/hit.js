/**
 * Which of some shapes are under the pointer, and which lie in a rectangle.
 *
 * @module
 */

import { contains, overlap } from "./bounds.js";
import { axesOf, insideCap, measure, placedWhole, polygonOfWhole, ringsOf } from "./caps.js";
import { shared } from "./regions.js";
import { isPrediction } from "./shapes.js";
import { nearestEdges } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./shapes.js").Shape} Shape */
/** @typedef {import("./bounds.js").Bounds} Bounds */

/** A prediction this much smaller than an annotation around it is another cap, not the same one seen twice. */
const ANOTHER_CAP = 1.6;

/**
 * The smallest shape the point lies in, as a nested one could not be reached otherwise; else the one whose
 * outline is nearest within `reach`. Where people have labelled a cap that is also predicted, theirs is meant.
 *
 * @param {Shape[]} shapes
 * @param {Point} point
 * @param {number} reach image pixels
 * @returns {Shape | null}
 */
export function pick(shapes, point, reach) {
  const [inside] = allAround(shapes, point);
  if (inside) return inside;
  let best = reach;
  let found = null;
  for (const shape of shapes) {
    const distance = distanceTo(shape, point, best);
    if (distance > best) continue;
    best = distance;
    found = shape;
  }
  return found;
}

/** The shapes that a point lies in, the one that is meant first. @type {(shapes: Shape[], point: Point) => Shape[]} */
export function allAround(shapes, point) {
  return shapes.filter(({ cap }) => insideCap(cap, ...point)).sort((a, b) => rank(a) - rank(b));
}

/**
 * Those whose outline passes within `reach` of the point, the nearest first.
 *
 * @type {(shapes: Shape[], point: Point, reach: number) => Shape[]}
 */
export function withRimNear(shapes, point, reach) {
  return shapes
    .map((shape) => ({ shape, distance: distanceTo(shape, point, reach) }))
    .filter(({ distance }) => distance <= reach)
    .sort((a, b) => a.distance - b.distance)
    .map(({ shape }) => shape);
}

/** @type {(shape: Shape) => number} */
function rank(shape) {
  return measure(shape.cap).area * (isPrediction(shape) ? ANOTHER_CAP : 1);
}

/**
 * Distance to what is drawn of the cap, or infinity when it is farther than `reach`.
 *
 * @param {Shape} shape
 * @param {Point} point
 * @param {number} reach
 * @returns {number}
 */
function distanceTo({ cap }, point, reach) {
  const { bounds } = measure(cap);
  const [x, y] = point;
  if (!bounds || !overlap(bounds, { x0: x - reach, y0: y - reach, x1: x + reach, y1: y + reach }))
    return Infinity;
  const placed = placedWhole(cap);
  let best = placed ? distanceToRim(placed, point) : Infinity;
  if (ringsOf(cap).length) {
    const edge = nearestEdges(cap, point, reach);
    if (edge) best = Math.min(best, Math.hypot(edge.foot[0] - x, edge.foot[1] - y));
  }
  return best;
}

/**
 * Exact for circles, close for the mild ellipses of caps.
 *
 * @type {(whole: import("../protocol.js").Whole, point: Point) => number}
 */
function distanceToRim(whole, [x, y]) {
  const { a, b, angle } = axesOf(whole);
  const dx = x - whole.cx;
  const dy = y - whole.cy;
  const u = dx * Math.cos(angle) + dy * Math.sin(angle);
  const v = dy * Math.cos(angle) - dx * Math.sin(angle);
  const distance = Math.hypot(u, v);
  const direction = Math.atan2(v, u);
  const rim = (a * b) / Math.hypot(b * Math.cos(direction), a * Math.sin(direction));
  return Math.abs(distance - rim);
}

/**
 * The shapes that lie wholly in the rectangle.
 *
 * @param {Shape[]} shapes
 * @param {Bounds} rect
 * @returns {Shape[]}
 */
export function within(shapes, rect) {
  return shapes.filter(({ cap }) => {
    const { bounds } = measure(cap);
    return bounds !== null && contains(rect, bounds);
  });
}

/** The shapes of which anything lies in the rectangle. @type {(shapes: Shape[], rect: Bounds) => Shape[]} */
export function touching(shapes, rect) {
  const { x0, y0, x1, y1 } = rect;
  return shapes.filter(({ cap }) => {
    const { bounds } = measure(cap);
    if (!bounds || !overlap(bounds, rect)) return false;
    return contains(rect, bounds) || shared(seenOrMarked(cap), [[x0, y0, x1, y0, x1, y1, x0, y1]]).length > 0;
  });
}

/** What is seen of a cap, else its mark. @type {(cap: Cap) => Outline} */
function seenOrMarked(cap) {
  if (cap.visible.length || !cap.mark) return cap.visible;
  return [cap.mark.kind === "polygon" ? cap.mark.points : polygonOfWhole(cap.mark)];
}
