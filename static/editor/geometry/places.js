/**
 * Places on rings, and the stretches between them.
 *
 * @module
 */

import { newCap } from "./caps.js";
import { crossingOf } from "./strokes.js";
import { nearestEdges } from "./vertices.js";

/** @typedef {import("../protocol.js").Point} Point */

/** Who goes no farther than this many times the distance to the rim makes straight for it. */
const STRAIGHT = 1.5;

/**
 * A place on a ring: on the edge after the vertex `index`.
 *
 * @typedef {{index: number, point: Point}} Place
 */

/**
 * Where a stroke begins and ends on a ring, and its points between: near the rim, else where it first and last
 * crosses it. One that begins beside the rim and makes straight for it begins where it crosses.
 *
 * @param {number[]} ring
 * @param {Point[]} stroke
 * @param {number} reach
 * @returns {{start: Place, end: Place, between: Point[]} | null}
 */
export function meeting(ring, stroke, reach) {
  const from = endOf(ring, stroke, reach);
  const to = endOf(ring, stroke.toReversed(), reach);
  if (!from || !to) return null;
  const between = stroke.slice(from.next, stroke.length - to.next);
  return between.length ? { start: from.place, end: to.place, between } : null;
}

/**
 * Where a stroke meets a ring first, and the index of the point of the stroke that follows.
 *
 * @type {(ring: number[], stroke: Point[], reach: number) => {place: Place, next: number} | null}
 */
function endOf(ring, stroke, reach) {
  const edge = nearestEdges(newCap({ visible: [ring] }), stroke[0], reach);
  const crossed = firstCrossing(ring, stroke, edge ? STRAIGHT * distance(stroke[0], edge.foot) : Infinity);
  if (crossed || !edge) return crossed;
  return { place: { index: edge.edges[0].index, point: edge.foot }, next: 1 };
}

/**
 * Where a stroke crosses a ring before it is `longest` long.
 *
 * @type {(ring: number[], stroke: Point[], longest: number) => {place: Place, next: number} | null}
 */
function firstCrossing(ring, stroke, longest) {
  let way = 0;
  for (let k = 1; k < stroke.length && way < longest; k++) {
    way += distance(stroke[k - 1], stroke[k]);
    for (let index = 0; index < ring.length / 2; index++) {
      const point = crossingOf(stroke[k - 1], stroke[k], vertex(ring, index), vertex(ring, index + 1));
      if (point) return { place: { index, point }, next: k };
    }
  }
  return null;
}

/** Where a straight line from inside a ring leaves it; null where it does not. @type {(ring: number[], from: Point, to: Point) => Point | null} */
export function crossingWith(ring, from, to) {
  const found = Array.from({ length: ring.length / 2 }, (_, index) => {
    return crossingOf(from, to, vertex(ring, index), vertex(ring, index + 1));
  }).filter((point) => point !== null);
  return found.sort((a, b) => distance(from, a) - distance(from, b))[0] ?? null;
}

/** How many vertices come after one place before another, in the order of the ring. @type {(ring: number[], from: Place, to: Place) => number} */
export function verticesAhead(ring, from, to) {
  const count = ring.length / 2;
  if (from.index !== to.index) return (to.index - from.index + count) % count;
  const last = vertex(ring, from.index);
  return distance(last, to.point) >= distance(last, from.point) ? 0 : count;
}

/** The rim from one place over so many vertices to another. @type {(ring: number[], from: Place, to: Place, count: number) => Point[]} */
export function stretch(ring, from, to, count) {
  const vertices = Array.from({ length: count }, (_, i) => vertex(ring, from.index + 1 + i));
  return [from.point, ...vertices, to.point];
}

/** @type {(line: Point[]) => number} */
export function lengthOf(line) {
  return line.slice(1).reduce((sum, to, i) => sum + distance(line[i], to), 0);
}

/** @type {(a: Point, b: Point) => number} */
export function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** The vertex of this number, counted round and round. @type {(ring: number[], number: number) => Point} */
function vertex(ring, number) {
  const i = 2 * (number % (ring.length / 2));
  return [ring[i], ring[i + 1]];
}

/** Of a ring or a line, x0, y0, x1, y1, … @type {(flat: number[]) => Point[]} */
export function pointsOf(flat) {
  return Array.from({ length: flat.length / 2 }, (_, i) => [flat[2 * i], flat[2 * i + 1]]);
}
