/**
 * What of a selected cap can be taken hold of: a vertex, the centre of a circle mark, its rim.
 *
 * @module
 */

import { hundredths, placedWhole } from "./caps.js";
import { draggedVertices, nearestVertices } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./vertices.js").Vertex} Vertex */
/** @typedef {{kind: "vertex", vertices: Vertex[]} | {kind: "centre"} | {kind: "rim"}} Handle */

export const SMALLEST_RADIUS = 1;

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
  const distance = ([x, y] = /** @type {Point} */ ([0, 0])) => Math.hypot(x - point[0], y - point[1]);
  /** @type {[number, Handle][]} */
  const candidates = [[distance([placed.cx, placed.cy]), { kind: "centre" }]];
  if (vertices.length)
    candidates.push([nearestVertexDistance(cap, point, vertices[0]), { kind: "vertex", vertices }]);
  if (placed.kind === "circle") {
    const rim = cap.visible.length
      ? Math.min(...rimPoints(placed).map(distance))
      : Math.abs(distance([placed.cx, placed.cy]) - placed.r);
    candidates.push([rim, { kind: "rim" }]);
  }
  const [best, handle] = candidates.reduce((a, b) => (b[0] < a[0] ? b : a));
  return best <= reach ? handle : null;
}

/** @type {(cap: Cap, point: Point, vertex: Vertex) => number} */
function nearestVertexDistance(cap, [x, y], { ring, index }) {
  const mark = cap.mark?.kind === "polygon" ? [cap.mark.points] : [];
  const points = [...cap.visible, ...mark][ring];
  return Math.hypot(points[2 * index] - x, points[2 * index + 1] - y);
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

/** @type {(a: Handle | null, b: Handle | null) => boolean} */
export function sameHandle(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}
