/**
 * Plane geometry worked out in other ways than the editor's.
 *
 * @module
 */

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/** Points of each edge looked at, by which a distance is known well enough. */
const STEPS = 500;

/** @type {(ring: number[]) => Point[]} */
export function pointsOf(ring) {
  return Array.from({ length: ring.length / 2 }, (_, i) => [ring[2 * i], ring[2 * i + 1]]);
}

/** Whether the ring winds around the point, by the sum of the angles. @type {(ring: number[], point: Point) => boolean} */
export function isAround(ring, [x, y]) {
  const angles = pointsOf(ring).map(([px, py]) => Math.atan2(py - y, px - x));
  const turns = angles.map((angle, i) => {
    const turn = angles[(i + 1) % angles.length] - angle;
    return turn - 2 * Math.PI * Math.round(turn / (2 * Math.PI));
  });
  return Math.abs(turns.reduce((sum, turn) => sum + turn)) > Math.PI;
}

/** By triangles around the first point. @type {(ring: number[]) => number} */
export function areaByTriangles(ring) {
  const [[x0, y0], ...rest] = pointsOf(ring);
  const triangles = rest.slice(1).map(([x, y], i) => {
    const [px, py] = rest[i];
    return ((px - x0) * (y - y0) - (x - x0) * (py - y0)) / 2;
  });
  return Math.abs(triangles.reduce((sum, area) => sum + area, 0));
}

/** To the nearest of many points on the ring. @type {(ring: number[], point: Point) => number} */
export function distanceBySteps(ring, [x, y]) {
  const points = pointsOf(ring);
  const distances = points.flatMap(([ax, ay], i) => {
    const [bx, by] = points[(i + 1) % points.length];
    return Array.from({ length: STEPS }, (_, k) => {
      return Math.hypot(ax + ((bx - ax) * k) / STEPS - x, ay + ((by - ay) * k) / STEPS - y);
    });
  });
  return distances.reduce((a, b) => Math.min(a, b));
}
