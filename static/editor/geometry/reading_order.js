/**
 * Caps in the order in which a page is read: by rows from above, and in each from left to right.
 *
 * @module
 */

import { boundsOf } from "./shapes.js";

/** @typedef {import("./shapes.js").Shape} Shape */
/** @typedef {{shape: Shape, x: number, y: number, height: number}} Placed */

/** A cap is of a row while its middle is no lower than this share of a usual cap's height under the row's first. */
const ROW_SHARE = 0.6;

/** @type {(shapes: Shape[]) => Shape[]} */
export function inReadingOrder(shapes) {
  const placed = shapes.flatMap(placeOf).sort((a, b) => a.y - b.y);
  const heights = placed.map(({ height }) => height).sort((a, b) => a - b);
  const step = ROW_SHARE * (heights[heights.length >> 1] ?? 1);
  /** @type {Placed[][]} */
  const rows = [];
  for (const each of placed) {
    const row = rows.at(-1);
    if (row && each.y - row[0].y <= step) row.push(each);
    else rows.push([each]);
  }
  return rows.flatMap((row) => row.sort((a, b) => a.x - b.x).map(({ shape }) => shape));
}

/** @type {(shape: Shape) => Placed[]} */
function placeOf(shape) {
  const bounds = boundsOf(shape);
  if (!bounds) return [];
  const { x0, y0, x1, y1 } = bounds;
  return [{ shape, x: (x0 + x1) / 2, y: (y0 + y1) / 2, height: y1 - y0 }];
}
