/**
 * Changes an outline along a stroke: the stretch between the places where the stroke begins and ends on the
 * rim gives way to it. A stroke outside adds to a cap, one inside cuts from it.
 *
 * @module
 */

import { areaOfRing, ringsOf, withRings } from "./caps.js";
import { lengthOf, meeting, stretch, verticesAhead } from "./places.js";
import { distanceToEdge, simplified } from "./strokes.js";
import { FEWEST } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */

/**
 * @typedef {Object} How
 * @property {number} reach  how far from the rim a stroke may begin and end, image pixels
 * @property {number} tolerance  how far the new rim may stray from the stroke, image pixels
 * @property {boolean} [other]  take the stretch on the other side
 * @property {(line: Point[]) => Point[]} [along]  what the drawn line follows instead, where others share the border
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
export function redrawnRing(ring, stroke, { reach, tolerance, other = false, along = asItIs }) {
  const met = meeting(ring, stroke, reach);
  if (!met) return null;
  const { start, end, between } = met;
  const ahead = verticesAhead(ring, start, end);
  const forwards = stretch(ring, start, end, ahead);
  const backwards = stretch(ring, end, start, ring.length / 2 - ahead).reverse();
  const first = isReplaced(forwards, backwards, between) !== other;
  const line = along(simplified([start.point, ...between, end.point], tolerance));
  const [kept, drawn] = first ? [backwards, line] : [forwards, line];
  const points = [...drawn, ...kept.slice(1, -1).reverse()];
  const made = points.flatMap(([x, y]) => [x, y]);
  return points.length >= FEWEST && areaOfRing(made) >= LEAST_AREA ? made : null;
}

/** @type {(line: Point[]) => Point[]} */
function asItIs(line) {
  return line;
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
