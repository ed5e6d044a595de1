/**
 * Lines drawn freehand, as points in image pixels.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Point} Point */

/** A loop that takes up less of a line than this is a slip of the hand, not an outline. */
const LEAST_LOOP = 0.6;

/**
 * Whether a line comes round to where it began: crosses its own beginning, or passes its first point within
 * `reach`.
 *
 * @param {readonly Point[]} points
 * @param {number} reach
 * @returns {boolean}
 */
export function comesRound(points, reach) {
  const edges = points.length - 1;
  const least = Math.ceil(LEAST_LOOP * edges);
  for (let j = Math.max(least, 2); j < edges; j++) {
    if (distanceToEdge(points[0], points[j], points[j + 1]) <= reach) return true;
    for (let i = 0; i <= j - least; i++) {
      if (edgesCross(points[i], points[i + 1], points[j], points[j + 1])) return true;
    }
  }
  return false;
}

/** Whether a-b and c-d cross; touching is not crossing. @type {(a: Point, b: Point, c: Point, d: Point) => boolean} */
export function edgesCross(a, b, c, d) {
  return sideOf(a, b, c) * sideOf(a, b, d) < 0 && sideOf(c, d, a) * sideOf(c, d, b) < 0;
}

/** Above zero on one side of the line a-b, below on the other. @type {(a: Point, b: Point, at: Point) => number} */
function sideOf([ax, ay], [bx, by], [x, y]) {
  return (bx - ax) * (y - ay) - (by - ay) * (x - ax);
}

/** @type {(at: Point, a: Point, b: Point) => number} */
export function distanceToEdge([x, y], [ax, ay], [bx, by]) {
  const [dx, dy] = [bx - ax, by - ay];
  const length = dx * dx + dy * dy;
  const along = length === 0 ? 0 : Math.min(1, Math.max(0, ((x - ax) * dx + (y - ay) * dy) / length));
  return Math.hypot(ax + along * dx - x, ay + along * dy - y);
}
