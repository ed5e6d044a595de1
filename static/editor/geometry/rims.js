/**
 * Changes an outline along a stroke: the stretch between the places where the stroke begins and ends on the
 * rim gives way to it. A stroke outside adds to a cap, one inside cuts from it.
 *
 * @module
 */

import { areaOfRing, ringsOf, withRings } from "./caps.js";
import { distance, lengthOf, meeting, stretch, verticesAhead } from "./places.js";
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

/** A stroke runs along the longer of two stretches where it is so much nearer to that than to the other, in distances … */
const NEARER = 0.5;
/** … and no farther from it than so many radii: one across a cap is nearer to something, too. */
const ALONG = 0.3;
/** A rim that is far off may be as far away from a stroke along the true one, in radii. */
const OFF = 0.37;
/** A stroke that bends away from a cap is so much less likely to be about it. */
const AWAY = 2;
/** A bend of less than this, as a share of the square over the chord, is none. */
const LEAST_BEND = 0.02;
/** A stroke whose ends are so much farther from a rim than it is long between is about something else. */
const MOSTLY_BESIDE = 2;
/** So many points of a stroke tell how it runs. */
const LOOKED_AT = 32;
/** An outline of less area, px², is none. */
const LEAST_AREA = 1;

/**
 * What a stroke would do to a ring.
 *
 * @typedef {Object} Redrawing
 * @property {Point[]} replaced  the stretch of the rim that gives way to the stroke
 * @property {Point[]} kept  the other one
 * @property {Point[]} line  the stroke, from rim to rim
 * @property {number} beside  how far the stroke is from being about this ring, image pixels
 */
/** Which part of a cap is redrawn, and how. @typedef {{part: number, redrawing: Redrawing}} Found */

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
  const found = redrawingOf(cap, stroke, how);
  return found && redrawnAs(cap, found, how);
}

/** The cap once that is done to it; null where nothing would be left. @type {(cap: Cap, found: Found, how: How) => Cap | null} */
export function redrawnAs(cap, { part, redrawing }, how) {
  const ring = redrawnBy(redrawing, how);
  return ring && withRings(cap, ringsOf(cap).with(part, ring));
}

/**
 * Which part of a cap a stroke is about, and what it would do to that; null where it is about none.
 *
 * @type {(cap: Cap, stroke: Point[], how: How) => Found | null}
 */
export function redrawingOf(cap, stroke, how) {
  const rings = ringsOf(cap).slice(0, cap.visible.length || undefined);
  const found = rings.flatMap((ring, part) => {
    const redrawing = redrawingOfRing(ring, stroke, how);
    return redrawing ? [{ part, redrawing }] : [];
  });
  return found.sort((a, b) => a.redrawing.beside - b.redrawing.beside)[0] ?? null;
}

/**
 * The ring with the stretch between the ends of the stroke redrawn: the one that leaves more of the cap, unless the
 * stroke runs along the longer.
 *
 * @type {(ring: number[], stroke: Point[], how: How) => number[] | null}
 */
export function redrawnRing(ring, stroke, how) {
  const found = redrawingOfRing(ring, stroke, how);
  return found && redrawnBy(found, how);
}

/** @type {(ring: number[], stroke: Point[], how: How) => Redrawing | null} */
function redrawingOfRing(ring, stroke, { reach, other = false }) {
  const radius = Math.sqrt(areaOfRing(ring) / Math.PI);
  const met = meeting(ring, stroke, Math.max(reach, OFF * radius));
  if (!met) return null;
  const { start, end, between } = met;
  const line = [start.point, ...between, end.point];
  const ends = distance(stroke[0], start.point) + distance(stroke[stroke.length - 1], end.point);
  if (ends > MOSTLY_BESIDE * lengthOf(line)) return null;
  const ahead = verticesAhead(ring, start, end);
  const ways = [
    stretch(ring, start, end, ahead),
    stretch(ring, end, start, ring.length / 2 - ahead).reverse(),
  ];
  const some = every(between, Math.ceil(between.length / LOOKED_AT));
  const meant = isReplaced(ways[0], ways[1], line, { some, radius }) ? 0 : 1;
  const replaced = other ? 1 - meant : meant;
  return {
    replaced: ways[replaced],
    kept: ways[1 - replaced],
    line,
    beside: ends + strayingFrom(ways[meant], some),
  };
}

/** @type {(redrawing: Redrawing, how: How) => number[] | null} */
function redrawnBy({ line, kept }, { tolerance, along = asItIs }) {
  const points = [...along(simplified(line, tolerance)), ...kept.slice(1, -1).reverse()];
  const made = points.flatMap(([x, y]) => [x, y]);
  return points.length >= FEWEST && areaOfRing(made) >= LEAST_AREA ? made : null;
}

/** @type {(line: Point[]) => Point[]} */
function asItIs(line) {
  return line;
}

/**
 * Whether a stroke takes the place of the first of two stretches: the one that it runs along, though that be the
 * longer; else the one that leaves more of the cap.
 *
 * @type {(first: Point[], second: Point[], line: Point[], stroke: {some: Point[], radius: number}) => boolean}
 */
function isReplaced(first, second, line, { some, radius }) {
  const shorter = lengthOf(first) <= lengthOf(second);
  const [short, long] = shorter ? [first, second] : [second, first];
  const away = mean(distances(some, long));
  if (away < ALONG * radius && away < NEARER * mean(distances(some, short))) return !shorter;
  return areaBetween(line, second) >= areaBetween(line, first);
}

/** @type {(line: Point[], stretch: Point[]) => number} */
function areaBetween(line, stretch) {
  return areaOfRing([...line, ...stretch.slice(1, -1).reverse()].flat());
}

/**
 * How little a stroke runs along a stretch: how far it is from it, and how unevenly; more where it bends the other
 * way, as a stroke along the rim of another cap does.
 *
 * @type {(stretch: Point[], between: Point[]) => number}
 */
function strayingFrom(stretch, between) {
  const all = distances(between, stretch);
  const uneven = Math.max(...all) - Math.min(...all);
  const [rim, stroke] = [bendOf(stretch), bendOf(between)];
  const away = Math.sign(rim) !== Math.sign(stroke) && Math.abs(stroke) > LEAST_BEND;
  return (away ? AWAY : 1) * (mean(all) + uneven);
}

/** The area between a line and its chord, as a share of the square over that: above zero on one side. @type {(line: Point[]) => number} */
function bendOf(line) {
  const [[fx, fy], to] = [line[0], line[line.length - 1]];
  const twice = line.reduce((sum, [x, y], i) => {
    const [nx, ny] = line[(i + 1) % line.length];
    return sum + (x - fx) * (ny - fy) - (nx - fx) * (y - fy);
  }, 0);
  return twice / 2 / Math.max(distance([fx, fy], to) ** 2, 1);
}

/** @type {(points: Point[], line: Point[]) => number[]} */
function distances(points, line) {
  return points.map((point) =>
    line.slice(1).reduce((best, to, i) => Math.min(best, distanceToEdge(point, line[i], to)), Infinity),
  );
}

/** @type {(numbers: number[]) => number} */
function mean(numbers) {
  return numbers.reduce((sum, each) => sum + each, 0) / numbers.length;
}

/** The first of some points, and every `step`th after it. @type {(points: Point[], step: number) => Point[]} */
function every(points, step) {
  return points.filter((_, i) => i % step === 0);
}
