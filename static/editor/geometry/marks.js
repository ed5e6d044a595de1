/**
 * Whose mark a circle is that was dragged out by hand.
 *
 * @module
 */

import { boundsOfPoints } from "./bounds.js";
import { lengthOf, pointsOf } from "./places.js";
import { areaOfRing, axesOf, insideRing, insideWhole, measure, placedWhole } from "./caps.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Fitted} Fitted */
/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Whole} Whole */

/** A mark goes around what is seen of its cap: around this share of it, wherever it was begun; */
const LEAST_SHARE = 0.5;
/** or around this share, where it was begun well inside the whole outline that was worked out. */
const LEAST_SHARE_INSIDE = 0.1;
/** Well inside: within an ellipse of this share of the axes. */
const WELL_INSIDE = 0.75;
/** What is seen of a cap reaches across at least this many radii of its mark; a bud beside it does not. */
const LEAST_REACH = 0.6;
/** A circle of less than this share of what is seen is not around the cap, wherever it was begun. */
const LEAST_AREA = 0.2;
/** Of two circles of one cap the smaller is this large at least, and the centres no farther apart, in radii. */
const ALIKE = 0.5;
const SAMPLES = 24;
/** A cap of which less than this share of the whole outline is seen is half hidden; */
const SEEN = 0.8;
/** or one of whose outline more than this share is not its own rim. */
const HIDDEN = 0.2;

/**
 * Whether a circle is the mark of this cap, rather than a cap of its own beside it or upon it.
 *
 * @param {Circle} circle
 * @param {Pick<import("./shapes.js").Shape, "cap" | "whole">} shape
 * @param {{halfHidden?: boolean}} [how]  a half-hidden cap without a mark is meant wherever the circle was begun
 * @returns {boolean}
 */
export function isMarkOf(circle, { cap, whole }, { halfHidden = false } = {}) {
  const placed = placedWhole(cap);
  if (cap.visible.length === 0) return placed !== null && alike(circle, placed);
  const { bounds, area } = measure({ ...cap, mark: null });
  if (!bounds || Math.PI * circle.r ** 2 < LEAST_AREA * area) return false;
  if (cap.visible.some((ring) => insideRing(ring, circle.cx, circle.cy))) return true;
  if (halfHidden && !cap.mark) return shareInside(cap.visible, circle) >= LEAST_SHARE_INSIDE;
  const reach = Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0);
  const least = whole && isWellInside(whole, circle) ? LEAST_SHARE_INSIDE : LEAST_SHARE;
  return reach >= LEAST_REACH * circle.r && shareInside(cap.visible, circle) >= least;
}

/**
 * Whether much of a cap lies under its neighbours or beyond the photo, as far as its whole outline tells.
 *
 * @type {(shape: Pick<import("./shapes.js").Shape, "cap" | "whole">, fitted: Fitted | null) => boolean}
 */
export function isHalfHidden({ cap, whole }, fitted) {
  const { area } = measure({ ...cap, mark: null });
  const { a, b } = whole ? axesOf(whole) : { a: 0, b: 0 };
  if (area < SEEN * Math.PI * a * b) return true;
  const arcs = (fitted?.arcs ?? []).map(({ kind, points }) => ({ kind, length: lengthOf(pointsOf(points)) }));
  const all = arcs.reduce((sum, { length }) => sum + length, 0);
  const hidden = arcs.filter(({ kind }) => kind === "hidden" || kind === "border");
  return hidden.reduce((sum, { length }) => sum + length, 0) > HIDDEN * all;
}

/** @type {(whole: Whole, circle: Circle) => boolean} */
function isWellInside(whole, { cx, cy }) {
  const x = whole.cx + (cx - whole.cx) / WELL_INSIDE;
  const y = whole.cy + (cy - whole.cy) / WELL_INSIDE;
  return insideWhole(whole, x, y);
}

/**
 * Whether one circle is the other placed better: about where it is, and about as large.
 *
 * @type {(circle: Circle, placed: Whole) => boolean}
 */
function alike({ cx, cy, r }, placed) {
  const { a, b } = axesOf(placed);
  const radius = Math.sqrt(a * b);
  const apart = Math.hypot(cx - placed.cx, cy - placed.cy);
  return Math.min(r, radius) >= ALIKE * Math.max(r, radius) && apart <= ALIKE * Math.min(r, radius);
}

/**
 * The share of an outline's area that lies in a whole one, by samples.
 *
 * @type {(visible: Outline, whole: Whole) => number}
 */
export function shareInside(visible, whole) {
  const all = visible.reduce((sum, ring) => sum + areaOfRing(ring), 0);
  const inside = visible.reduce((sum, ring) => {
    const samples = samplesOf(ring);
    const share = samples.filter(([x, y]) => insideWhole(whole, x, y)).length / Math.max(samples.length, 1);
    return sum + areaOfRing(ring) * share;
  }, 0);
  return all === 0 ? 0 : inside / all;
}

/** Points inside the ring, evenly spread. @type {(ring: number[]) => Point[]} */
function samplesOf(ring) {
  const { x0, y0, x1, y1 } = boundsOfPoints(ring);
  const steps = Array.from({ length: SAMPLES }, (_, i) => (i + 0.5) / SAMPLES);
  return steps
    .flatMap((across) => steps.map((down) => point(x0 + across * (x1 - x0), y0 + down * (y1 - y0))))
    .filter(([x, y]) => insideRing(ring, x, y));
}

/** @type {(x: number, y: number) => Point} */
function point(x, y) {
  return [x, y];
}
