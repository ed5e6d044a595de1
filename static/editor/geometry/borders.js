/**
 * Borders that caps share: a line drawn by hand follows a neighbour's rim where it runs along it, and what one
 * cap gains its neighbours lose.
 *
 * @module
 */

import { areaOfRing, hundredths, newCap } from "./caps.js";
import { lengthOf, stretch, verticesAhead } from "./places.js";
import { areaOf, shared, without } from "./regions.js";
import { nearestEdges } from "./vertices.js";

/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./places.js").Place} Place */
/** @typedef {{point: Point, ring: number[] | null, place: Place | null}} Snapped */

/** Along a neighbour's rim a line runs at most so much farther than it was drawn. */
const LONGEST_WAY = 1.5;
/** Less than this, px², is not worth taking. */
const LEAST_AREA = 1;
/** What is parted from a neighbour goes where it is smaller than this, px², and than that share of what is left. */
const CRUMB = { area: 40, share: 0.05 };

/**
 * The line drawn onto the rims that it passes within `reach`, and along them between two such places.
 *
 * @param {Point[]} line  its ends stay
 * @param {number[][]} rings
 * @param {number} reach  image pixels
 * @returns {Point[]}
 */
export function snapped(line, rings, reach) {
  if (rings.length === 0) return line;
  const last = line.length - 1;
  const all = line.map((point, i) => (i === 0 || i === last ? free(point) : nearestOn(rings, point, reach)));
  return all.flatMap((at, i) => (i === 0 ? [at.point] : [...between(all[i - 1], at), at.point]));
}

/** @type {(point: Point) => Snapped} */
function free(point) {
  return { point, ring: null, place: null };
}

/** @type {(rings: number[][], point: Point, reach: number) => Snapped} */
function nearestOn(rings, point, reach) {
  const found = nearestEdges(newCap({ visible: rings }), point, reach);
  if (!found) return free(point);
  const [{ ring, index }] = found.edges;
  const [x, y] = found.foot;
  return { point: [hundredths(x), hundredths(y)], ring: rings[ring], place: { index, point: found.foot } };
}

/** The vertices of a rim between two places on it, the shorter way round. @type {(from: Snapped, to: Snapped) => Point[]} */
function between(from, to) {
  if (!from.ring || from.ring !== to.ring || !from.place || !to.place) return [];
  const count = from.ring.length / 2;
  const ahead = verticesAhead(from.ring, from.place, to.place);
  const ways = [
    stretch(from.ring, from.place, to.place, ahead),
    stretch(from.ring, to.place, from.place, count - ahead).reverse(),
  ].sort((a, b) => lengthOf(a) - lengthOf(b));
  const straight = lengthOf([from.point, to.point]);
  return lengthOf(ways[0]) <= LONGEST_WAY * straight + 1 ? ways[0].slice(1, -1) : [];
}

/**
 * What is left of a neighbour when another cap gains `gained`; null where it loses nothing, or would lose all.
 *
 * @type {(neighbour: Outline, gained: Outline) => Outline | null}
 */
export function leftOf(neighbour, gained) {
  if (gained.length === 0 || areaOf(shared(neighbour, gained)) < LEAST_AREA) return null;
  const left = withoutCrumbs(without(neighbour, gained), neighbour.length);
  return left.length ? left : null;
}

/** Without pieces that a cap of so many parts has not had before, where they are too small to be seen. @type {(left: Outline, parts: number) => Outline} */
function withoutCrumbs(left, parts) {
  const bySize = left.toSorted((a, b) => areaOfRing(b) - areaOfRing(a));
  const least = Math.min(CRUMB.area, CRUMB.share * areaOf(left));
  return left.filter((ring) => areaOfRing(ring) >= least || bySize.indexOf(ring) < parts);
}
