/**
 * Upright rectangles. `x0 <= x1` and `y0 <= y1`; image pixels where nothing else is said.
 *
 * @module
 */

/** @typedef {{x0: number, y0: number, x1: number, y1: number}} Bounds */

/** The least rectangle around both. @type {(a: Bounds, b: Bounds) => Bounds} */
export function joined(a, b) {
  return {
    x0: Math.min(a.x0, b.x0),
    y0: Math.min(a.y0, b.y0),
    x1: Math.max(a.x1, b.x1),
    y1: Math.max(a.y1, b.y1),
  };
}

/** The least rectangle around all of them; null around none. @type {(all: Bounds[]) => Bounds | null} */
export function joinedAll(all) {
  return all.length ? all.reduce(joined) : null;
}

/** Farther out by `by` on every side. @type {(bounds: Bounds, by: number) => Bounds} */
export function grown(bounds, by) {
  return { x0: bounds.x0 - by, y0: bounds.y0 - by, x1: bounds.x1 + by, y1: bounds.y1 + by };
}

/** Whether they share a point; touching edges do. @type {(a: Bounds, b: Bounds) => boolean} */
export function overlap(a, b) {
  return a.x0 <= b.x1 && b.x0 <= a.x1 && a.y0 <= b.y1 && b.y0 <= a.y1;
}

/** Whether `inner` lies wholly in `outer`. @type {(outer: Bounds, inner: Bounds) => boolean} */
export function contains(outer, inner) {
  return inner.x0 >= outer.x0 && inner.y0 >= outer.y0 && inner.x1 <= outer.x1 && inner.y1 <= outer.y1;
}

/** The least rectangle around the points x0, y0, x1, y1, … @type {(points: number[]) => Bounds} */
export function boundsOfPoints(points) {
  const bounds = { x0: Infinity, y0: Infinity, x1: -Infinity, y1: -Infinity };
  for (let i = 0; i < points.length; i += 2) {
    bounds.x0 = Math.min(bounds.x0, points[i]);
    bounds.x1 = Math.max(bounds.x1, points[i]);
    bounds.y0 = Math.min(bounds.y0, points[i + 1]);
    bounds.y1 = Math.max(bounds.y1, points[i + 1]);
  }
  return bounds;
}
