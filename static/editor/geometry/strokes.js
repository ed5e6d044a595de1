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

/**
 * Where a-b crosses c-d, a point on the line counting as beside it; null where it does not.
 *
 * @type {(a: Point, b: Point, c: Point, d: Point) => Point | null}
 */
export function crossingOf(a, b, c, d) {
  const [from, to] = [sideOf(c, d, a), sideOf(c, d, b)];
  if (from > 0 === to > 0 || sideOf(a, b, c) > 0 === sideOf(a, b, d) > 0) return null;
  const along = from / (from - to);
  return [a[0] + along * (b[0] - a[0]), a[1] + along * (b[1] - a[1])];
}

/**
 * Those points of a line from which it strays no farther than `tolerance`, as Douglas and Peucker choose them;
 * its ends stay.
 *
 * @param {Point[]} points  at least two
 * @param {number} tolerance
 * @returns {Point[]}
 */
export function simplified(points, tolerance) {
  const kept = new Set([0, points.length - 1]);
  const pieces = [[0, points.length - 1]];
  for (let piece = pieces.pop(); piece; piece = pieces.pop()) {
    const [first, last] = piece;
    let [farthest, best] = [-1, tolerance];
    for (let i = first + 1; i < last; i++) {
      const away = distanceToEdge(points[i], points[first], points[last]);
      if (away > best) [farthest, best] = [i, away];
    }
    if (farthest < 0) continue;
    kept.add(farthest);
    pieces.push([first, farthest], [farthest, last]);
  }
  return points.filter((_, i) => kept.has(i));
}
