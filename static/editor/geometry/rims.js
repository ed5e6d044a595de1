/**
 * Changes an outline along a stroke: the stretch between the places where the stroke begins and ends on the
 * rim gives way to it. A stroke outside adds to a cap, one inside cuts from it.
 *
 * @module
 */

import { areaOfRing, newCap, ringsOf, withRings } from "./caps.js";
import { crossingOf, distanceToEdge, simplified } from "./strokes.js";
import { FEWEST, nearestEdges } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */

/**
 * A place on a ring: on the edge after the vertex `index`.
 *
 * @typedef {{index: number, point: Point}} Place
 */

/**
 * @typedef {Object} How
 * @property {number} reach  how far from the rim a stroke may begin and end, image pixels
 * @property {number} tolerance  how far the new rim may stray from the stroke, image pixels
 * @property {boolean} [other]  take the stretch on the other side
 */

/** A stroke runs along the longer of two stretches where it is so much nearer to that, in distances. */
const NEARER = 0.5;
/** An outline of less area, px², is none. */
const LEAST_AREA = 1;

/**
 * The cap with a stretch of its visible outline (of its polygon mark, where nothing is visible) redrawn; null
 * where the stroke does not begin and end on the rim of one part.
 *
 * @param {Cap} cap
 * @param {Point[]} stroke
 * @param {How} how
 * @returns {Cap | null}
 */
export function redrawnCap(cap, stroke, how) {
  const rings = ringsOf(cap);
  const parts = cap.visible.length || rings.length;
  for (let i = 0; i < parts; i++) {
    const ring = redrawnRing(rings[i], stroke, how);
    if (ring) return withRings(cap, rings.with(i, ring));
  }
  return null;
}

/**
 * The ring with the stretch between the ends of the stroke redrawn: the shorter one, unless the stroke runs
 * along the longer.
 *
 * @param {number[]} ring
 * @param {Point[]} stroke
 * @param {How} how
 * @returns {number[] | null}
 */
export function redrawnRing(ring, stroke, { reach, tolerance, other = false }) {
  const met = meeting(ring, stroke, reach);
  if (!met) return null;
  const { start, end, between } = met;
  const ahead = verticesAhead(ring, start, end);
  const forwards = stretch(ring, start, end, ahead);
  const backwards = stretch(ring, end, start, ring.length / 2 - ahead).reverse();
  const first = isReplaced(forwards, backwards, between) !== other;
  const line = simplified([start.point, ...between, end.point], tolerance);
  const [kept, drawn] = first ? [backwards, line] : [forwards, line];
  const points = [...drawn, ...kept.slice(1, -1).reverse()];
  const made = points.flatMap(([x, y]) => [x, y]);
  return points.length >= FEWEST && areaOfRing(made) >= LEAST_AREA ? made : null;
}

/**
 * Where a stroke begins and ends on a ring, and its points between: near the rim, else where it first and last
 * crosses it.
 *
 * @param {number[]} ring
 * @param {Point[]} stroke
 * @param {number} reach
 * @returns {{start: Place, end: Place, between: Point[]} | null}
 */
function meeting(ring, stroke, reach) {
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
  if (edge) return { place: { index: edge.edges[0].index, point: edge.foot }, next: 1 };
  for (let k = 1; k < stroke.length; k++) {
    for (let index = 0; index < ring.length / 2; index++) {
      const point = crossingOf(stroke[k - 1], stroke[k], vertex(ring, index), vertex(ring, index + 1));
      if (point) return { place: { index, point }, next: k };
    }
  }
  return null;
}

/** How many vertices come after one place before another, in the order of the ring. @type {(ring: number[], from: Place, to: Place) => number} */
function verticesAhead(ring, from, to) {
  const count = ring.length / 2;
  if (from.index !== to.index) return (to.index - from.index + count) % count;
  const last = vertex(ring, from.index);
  return distance(last, to.point) >= distance(last, from.point) ? 0 : count;
}

/** The rim from one place over so many vertices to another. @type {(ring: number[], from: Place, to: Place, count: number) => Point[]} */
function stretch(ring, from, to, count) {
  const vertices = Array.from({ length: count }, (_, i) => vertex(ring, from.index + 1 + i));
  return [from.point, ...vertices, to.point];
}

/** Whether the first of two stretches is the one that the stroke takes the place of. @type {(first: Point[], second: Point[], between: Point[]) => boolean} */
function isReplaced(first, second, between) {
  const shorter = lengthOf(first) <= lengthOf(second);
  const [short, long] = shorter ? [first, second] : [second, first];
  const alongTheLonger = meanDistance(between, long) < NEARER * meanDistance(between, short);
  return shorter !== alongTheLonger;
}

/** @type {(points: Point[], line: Point[]) => number} */
function meanDistance(points, line) {
  const distances = points.map((point) =>
    line.slice(1).reduce((best, to, i) => Math.min(best, distanceToEdge(point, line[i], to)), Infinity),
  );
  return distances.reduce((sum, each) => sum + each, 0) / distances.length;
}

/** @type {(line: Point[]) => number} */
function lengthOf(line) {
  return line.slice(1).reduce((sum, to, i) => sum + distance(line[i], to), 0);
}

/** @type {(a: Point, b: Point) => number} */
function distance(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

/** The vertex of this number, counted round and round. @type {(ring: number[], number: number) => Point} */
function vertex(ring, number) {
  const i = 2 * (number % (ring.length / 2));
  return [ring[i], ring[i + 1]];
}
