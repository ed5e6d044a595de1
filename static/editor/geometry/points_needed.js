/**
 * How many points an outline drawn by hand should have, by the size of the cap: 10, 20 and 25 for small, medium and
 * large ones, as COCO divides them.
 *
 * @module
 */

import { areaOfRing, placedWhole } from "./caps.js";
import { turned } from "./regions.js";

/** @typedef {import("./shapes.js").Shape} Shape */

/** px² */
const MEDIUM_FROM = 32 ** 2;
const LARGE_FROM = 96 ** 2;
/** Rims that were cut at each other are on hundredths of a pixel. */
const SAME_PX = 0.02;

/** @type {(area: number) => 10 | 20 | 25} */
export function pointsNeeded(area) {
  return area < MEDIUM_FROM ? 10 : area < LARGE_FROM ? 20 : 25;
}

/**
 * Whether an outline that people have drawn has too few points. What a network found or a circle gave is generated and
 * was not drawn by points, nor was the rim of a cap in front at which an outline ends.
 *
 * @param {Shape} shape
 * @param {Shape[]} others  the caps around it; this one may be among them
 */
export function isCoarse({ uid, cap }, others) {
  if (cap.ignored || cap.prediction !== null || placedWhole(cap) || cap.visible.length === 0) return false;
  const area = cap.visible.reduce((sum, ring) => sum + areaOfRing(ring), 0);
  const rims = others.filter((other) => other.uid !== uid).flatMap((other) => other.cap.visible);
  const points = cap.visible.reduce((sum, ring) => sum + placedPoints(ring, rims), 0);
  return points < pointsNeeded(area);
}

/**
 * How many points of a rim a person placed: all but those where it was cut at another. Two rims share the points of
 * such a border; they are of the cap in front, for which they bulge outwards.
 *
 * @type {(ring: number[], rims: number[][]) => number}
 */
function placedPoints(ring, rims) {
  const count = ring.length / 2;
  const isShared = Array.from({ length: count }, (_, i) => rims.some((rim) => holds(rim, ring[2 * i], ring[2 * i + 1])));
  const first = isShared.indexOf(false);
  if (first < 0) return count;
  let placed = 0;
  for (let i = first; i < first + count; ) {
    let end = i;
    while (isShared[end % count]) end++;
    if (end === i || turned(stretchOf(ring, i - 1, end)) * turned(ring) > 0) placed += Math.max(1, end - i);
    i = Math.max(end, i + 1);
  }
  return placed;
}

/** @type {(ring: number[], x: number, y: number) => boolean} */
function holds(ring, x, y) {
  for (let i = 0; i < ring.length; i += 2) {
    if (Math.abs(ring[i] - x) < SAME_PX && Math.abs(ring[i + 1] - y) < SAME_PX) return true;
  }
  return false;
}

/** The points from one index to another, both among them. @type {(ring: number[], from: number, to: number) => number[]} */
function stretchOf(ring, from, to) {
  const count = ring.length / 2;
  return Array.from({ length: to - from + 1 }, (_, k) => (from + k + count) % count).flatMap((i) => [
    ring[2 * i],
    ring[2 * i + 1],
  ]);
}
