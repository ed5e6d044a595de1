/**
 * Plane geometry of caps as far as drawing and pointing need it, image pixels throughout. Fitting is the
 * server's business.
 *
 * @module
 */

import { boundsOfPoints, joinedAll } from "./bounds.js";
import { movedArcs } from "./told_arcs.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Circle} Circle */
/** @typedef {import("../protocol.js").Ellipse} Ellipse */
/** @typedef {import("../protocol.js").Mark} Mark */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Whole} Whole */
/** @typedef {import("./bounds.js").Bounds} Bounds */
/** @typedef {{bounds: Bounds | null, area: number}} Measures */

/** @type {WeakMap<Cap, Measures>} */
const measured = new WeakMap();

/** @type {(fields?: Partial<Cap>) => Cap} */
export function newCap(fields = {}) {
  return {
    visible: [],
    mark: null,
    ignored: false,
    doubtful: false,
    order: null,
    category: "mushroom",
    prediction: null,
    ...fields,
  };
}

/**
 * Everything of the cap that has vertices: the parts of the visible outline, then a polygon mark.
 *
 * @param {Cap} cap
 * @returns {number[][]}
 */
export function ringsOf(cap) {
  return cap.mark?.kind === "polygon" ? [...cap.visible, cap.mark.points] : cap.visible;
}

/**
 * The same cap with other rings, in the order of `ringsOf`.
 *
 * @param {Cap} cap
 * @param {number[][]} rings
 * @returns {Cap}
 */
export function withRings(cap, rings) {
  const parts = cap.visible.length;
  const mark = cap.mark?.kind === "polygon" ? { ...cap.mark, points: rings[parts] } : cap.mark;
  return { ...cap, visible: rings.slice(0, parts), mark };
}

/** @type {(cap: Cap, dx: number, dy: number) => Cap} */
export function movedCap(cap, dx, dy) {
  const moved = withRings(
    cap,
    ringsOf(cap).map((ring) => ring.map((value, i) => value + (i % 2 ? dy : dx))),
  );
  const mark = moved.mark && movedMark(moved.mark, dx, dy);
  return cap.arcs ? { ...moved, mark, arcs: movedArcs(cap.arcs, dx, dy) } : { ...moved, mark };
}

/** @type {(mark: Mark, dx: number, dy: number) => Mark} */
function movedMark(mark, dx, dy) {
  return mark.kind === "polygon" ? mark : { ...mark, cx: mark.cx + dx, cy: mark.cy + dy };
}

/** @type {(whole: Whole | null, dx: number, dy: number) => Whole | null} */
export function movedWhole(whole, dx, dy) {
  return whole && { ...whole, cx: whole.cx + dx, cy: whole.cy + dy };
}

/**
 * The whole outline that needs no fitting: a circle or ellipse a person placed is itself.
 *
 * @param {Cap} cap
 * @returns {Whole | null}
 */
export function placedWhole(cap) {
  return cap.mark && cap.mark.kind !== "polygon" ? cap.mark : null;
}

/**
 * Bounds and area of what is drawn of the cap, worked out once a cap.
 *
 * @param {Cap} cap
 * @returns {Measures}
 */
export function measure(cap) {
  let measures = measured.get(cap);
  if (!measures) {
    measures = { bounds: boundsOfCap(cap), area: areaOfCap(cap) };
    measured.set(cap, measures);
  }
  return measures;
}

/** @type {(cap: Cap) => Bounds | null} */
function boundsOfCap(cap) {
  const all = ringsOf(cap)
    .filter((ring) => ring.length >= 2)
    .map(boundsOfPoints);
  const placed = placedWhole(cap);
  if (placed) all.push(boundsOfWhole(placed));
  return joinedAll(all);
}

/** @type {(whole: Whole) => Bounds} */
export function boundsOfWhole(whole) {
  const { a, b, angle } = axesOf(whole);
  const rx = Math.hypot(a * Math.cos(angle), b * Math.sin(angle));
  const ry = Math.hypot(a * Math.sin(angle), b * Math.cos(angle));
  return { x0: whole.cx - rx, y0: whole.cy - ry, x1: whole.cx + rx, y1: whole.cy + ry };
}

/**
 * Semi-axes and the angle of a in radians.
 *
 * @param {Whole} whole
 * @returns {{a: number, b: number, angle: number}}
 */
export function axesOf(whole) {
  if (whole.kind === "circle") return { a: whole.r, b: whole.r, angle: 0 };
  return { a: whole.a, b: whole.b, angle: (whole.theta_deg * Math.PI) / 180 };
}

/** @type {(cap: Cap) => number} */
function areaOfCap(cap) {
  if (cap.visible.length) return cap.visible.reduce((sum, ring) => sum + areaOfRing(ring), 0);
  if (cap.mark?.kind === "polygon") return areaOfRing(cap.mark.points);
  const placed = placedWhole(cap);
  if (!placed) return 0;
  const { a, b } = axesOf(placed);
  return Math.PI * a * b;
}

/** @type {(ring: number[]) => number} */
export function areaOfRing(ring) {
  let twice = 0;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    twice += ring[j] * ring[i + 1] - ring[i] * ring[j + 1];
  }
  return Math.abs(twice) / 2;
}

/** @type {(ring: number[], x: number, y: number) => boolean} */
export function insideRing(ring, x, y) {
  let inside = false;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    const crosses = ring[i + 1] > y !== ring[j + 1] > y;
    if (crosses && x < ring[i] + ((y - ring[i + 1]) / (ring[j + 1] - ring[i + 1])) * (ring[j] - ring[i])) {
      inside = !inside;
    }
  }
  return inside;
}

/** @type {(whole: Whole, x: number, y: number) => boolean} */
export function insideWhole(whole, x, y) {
  const { a, b, angle } = axesOf(whole);
  const dx = x - whole.cx;
  const dy = y - whole.cy;
  const u = (dx * Math.cos(angle) + dy * Math.sin(angle)) / a;
  const v = (dy * Math.cos(angle) - dx * Math.sin(angle)) / b;
  return u * u + v * v <= 1;
}

/**
 * Whether the point lies in the visible outline, or in the mark of a cap that has no visible outline.
 *
 * @param {Cap} cap
 * @param {number} x
 * @param {number} y
 * @returns {boolean}
 */
export function insideCap(cap, x, y) {
  const { bounds } = measure(cap);
  if (!bounds || x < bounds.x0 || x > bounds.x1 || y < bounds.y0 || y > bounds.y1) return false;
  if (cap.visible.length) return cap.visible.some((ring) => insideRing(ring, x, y));
  if (cap.mark?.kind === "polygon") return insideRing(cap.mark.points, x, y);
  const placed = placedWhole(cap);
  return placed !== null && insideWhole(placed, x, y);
}

/**
 * A regular polygon inscribed in the circle with a chord error of at most 0.1 px, so its centre is the
 * circle's.
 *
 * @param {Circle} circle
 * @returns {number[]}
 */
export function polygonOfCircle(circle) {
  const step = 2 * Math.acos(Math.max(0, 1 - 0.1 / Math.max(circle.r, 0.2)));
  const count = Math.max(8, Math.ceil((2 * Math.PI) / step));
  return Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count).flatMap((angle) => [
    circle.cx + circle.r * Math.cos(angle),
    circle.cy + circle.r * Math.sin(angle),
  ]);
}

/** The same for an ellipse, with as many points as its circle. @type {(whole: Whole) => number[]} */
export function polygonOfWhole(whole) {
  if (whole.kind === "circle") return polygonOfCircle(whole);
  const { a, b, angle } = axesOf(whole);
  const unit = polygonOfCircle({ kind: "circle", cx: 0, cy: 0, r: Math.max(a, b) });
  return unit.map((_, i) => {
    const k = i - (i % 2);
    const [u, v] = [(unit[k] / Math.max(a, b)) * a, (unit[k + 1] / Math.max(a, b)) * b];
    return i % 2
      ? whole.cy + u * Math.sin(angle) + v * Math.cos(angle)
      : whole.cx + u * Math.cos(angle) - v * Math.sin(angle);
  });
}

/**
 * The circle of the same centre and area.
 *
 * @param {Whole} whole
 * @returns {Circle}
 */
export function circleOfWhole(whole) {
  const { a, b } = axesOf(whole);
  return { kind: "circle", cx: whole.cx, cy: whole.cy, r: Math.sqrt(a * b) };
}

/** Hundredths of a pixel: what is kept of where a hand has pointed. @type {(value: number) => number} */
export function hundredths(value) {
  return Math.round(value * 100) / 100;
}

/** A circle or ellipse as a hand places it. @type {(whole: Whole) => Whole} */
export function rounded(whole) {
  const [cx, cy] = [hundredths(whole.cx), hundredths(whole.cy)];
  if (whole.kind === "circle") return { ...whole, cx, cy, r: hundredths(whole.r) };
  const [a, b] = [hundredths(whole.a), hundredths(whole.b)];
  return { ...whole, cx, cy, a, b, theta_deg: hundredths(whole.theta_deg) % 180 };
}
