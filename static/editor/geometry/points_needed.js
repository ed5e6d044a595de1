/**
 * How many points an outline drawn by hand should have, by the size of the cap: 10, 20 and 25 for small, medium and
 * large ones, as COCO divides them.
 *
 * @module
 */

import { areaOfRing, placedWhole } from "./caps.js";

/** @typedef {import("./shapes.js").Shape} Shape */

/** px² */
const MEDIUM_FROM = 32 ** 2;
const LARGE_FROM = 96 ** 2;

/** @type {(area: number) => 10 | 20 | 25} */
export function pointsNeeded(area) {
  return area < MEDIUM_FROM ? 10 : area < LARGE_FROM ? 20 : 25;
}

/**
 * Whether an outline that people have drawn has too few points. What a network found or a circle gave is generated and
 * was not drawn by points.
 *
 * @type {(shape: Shape) => boolean}
 */
export function isCoarse({ cap }) {
  if (cap.ignored || cap.prediction !== null || placedWhole(cap) || cap.visible.length === 0) return false;
  const area = cap.visible.reduce((sum, ring) => sum + areaOfRing(ring), 0);
  const points = cap.visible.reduce((sum, ring) => sum + ring.length / 2, 0);
  return points < pointsNeeded(area);
}
