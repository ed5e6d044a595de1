/**
 * What of a selected cap can be taken hold of: a vertex, the centre of a circle mark, its rim.
 *
 * @module
 */

import { boundsOfWhole, hundredths, measure, placedWhole, ringsOf } from "./caps.js";
import { draggedVertices, nearestVertices, vertexAt } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./vertices.js").Vertex} Vertex */
/** @typedef {{kind: "vertex", vertices: Vertex[]} | {kind: "centre"} | {kind: "rim"}} Handle */

export const SMALLEST_RADIUS = 1;
/** Handles no closer than this, CSS pixels, or they would hide the rim they are on. */
export const HANDLE_GAP_PX = 13;

/** The points of the rim that show a handle. @type {(circle: Circle) => Point[]} */
export function rimPoints({ cx, cy, r }) {
  return [
    [cx + r, cy],
    [cx, cy + r],
    [cx - r, cy],
    [cx, cy - r],
  ];
}

/**
 * The handle nearest to a point within `reach` image pixels.
 *
 * @param {Cap} cap
 * @param {Point} point
 * @param {number} reach
 * @returns {Handle | null}
 */
export function nearestHandle(cap, point, reach) {
  const vertices = nearestVertices(cap, point, reach);
  const placed = placedWhole(cap);
  if (!placed) return vertices.length ? { kind: "vertex", vertices } : null;
  const distance = (/** @type {Point} */ [x, y]) => Math.hypot(x - point[0], y - point[1]);
  /** @type {[number, Handle][]} */
  const candidates = [[distance([placed.cx, placed.cy]), { kind: "centre" }]];
  if (vertices.length) candidates.push([distance(vertexAt(cap, vertices[0])), { kind: "vertex", vertices }]);
  if (placed.kind === "circle") {
    const rim = cap.visible.length
      ? Math.min(...rimPoints(placed).map(distance))
      : Math.abs(distance([placed.cx, placed.cy]) - placed.r);
    candidates.push([rim, { kind: "rim" }]);
  }
  const [best, handle] = candidates.reduce((a, b) => (b[0] < a[0] ? b : a));
  return best <= reach ? handle : null;
}

/**
 * The handle of a circle that is drawn at a point, within `reach`: its centre, or one of the four on its rim.
 *
 * @param {Circle} circle
 * @param {Point} point
 * @param {number} reach
 * @returns {Handle | null}
 */
export function shownHandle(circle, [x, y], reach) {
  // On a small circle the handles would leave no place to press beside them.
  const near = Math.min(reach, circle.r / 2);
  if (Math.hypot(circle.cx - x, circle.cy - y) <= near) return { kind: "centre" };
  const rim = Math.min(...rimPoints(circle).map(([px, py]) => Math.hypot(px - x, py - y)));
  return rim <= near ? { kind: "rim" } : null;
}

/**
 * The cap after a handle was moved by (dx, dy) from `from`.
 *
 * @param {Cap} cap
 * @param {Handle} handle
 * @param {{dx: number, dy: number, from: Point, pull: number}} by
 * @returns {Cap}
 */
export function movedHandle(cap, handle, { dx, dy, from, pull }) {
  if (handle.kind === "vertex") return draggedVertices(cap, handle.vertices, { dx, dy, pull });
  const mark = placedWhole(cap);
  if (!mark) return cap;
  if (handle.kind === "centre") return { ...cap, mark: { ...mark, cx: mark.cx + dx, cy: mark.cy + dy } };
  if (mark.kind !== "circle") return cap;
  const before = Math.hypot(from[0] - mark.cx, from[1] - mark.cy);
  const after = Math.hypot(from[0] + dx - mark.cx, from[1] + dy - mark.cy);
  return { ...cap, mark: { ...mark, r: Math.max(SMALLEST_RADIUS, hundredths(mark.r + after - before)) } };
}

/**
 * The cap after a handle was moved by an arrow key; right and up make a circle larger.
 *
 * @param {Cap} cap
 * @param {Handle} handle
 * @param {number} dx
 * @param {number} dy
 * @returns {Cap}
 */
export function nudgedHandle(cap, handle, dx, dy) {
  const mark = placedWhole(cap);
  /** @type {Point} */
  const from = mark ? [boundsOfWhole(mark).x1, mark.cy] : [0, 0];
  const by = handle.kind === "rim" ? { dx: dx - dy, dy: 0 } : { dx, dy };
  return movedHandle(cap, handle, { ...by, from, pull: 0 });
}

/**
 * Whether the vertices of a cap are far enough apart for each to have a handle of its own.
 *
 * @param {Cap} cap
 * @param {number} gap  between handles, image pixels
 * @returns {boolean}
 */
export function handlesAreApart(cap, gap) {
  const { bounds } = measure(cap);
  if (!bounds) return false;
  const count = ringsOf(cap).reduce((sum, ring) => sum + ring.length / 2, 0);
  const around = 3 * Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0);
  return around / Math.max(count, 1) >= gap;
}
