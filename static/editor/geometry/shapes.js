/**
 * A shape: one cap as it is drawn, whether people agreed on it or a network predicted it. Shapes are plain
 * values; every function returns a new one.
 *
 * @module
 */

import { joined } from "./bounds.js";
import { axesOf, boundsOfWhole, measure, movedCap, movedWhole, placedWhole } from "./caps.js";

/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Prediction} Prediction */
/** @typedef {import("../protocol.js").Whole} Whole */
/** @typedef {import("./bounds.js").Bounds} Bounds */

/**
 * @typedef {Object} Shape
 * @property {string} uid
 * @property {Cap} cap
 * @property {number} revision  of the server's that it was made on; 0 before the server knows the cap
 * @property {boolean} deleted
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {number | null} score  of a prediction; null for what people agreed on
 * @property {boolean} checked  a person has looked at it and found it right, or put it right
 * @property {number} doubt  how much it is worth a look, between 0 and 1
 * @property {Point | null} [sd]  one standard deviation of the centre along x and y, where the server has said it
 */

/** A cap that nobody has seen before. @type {(uid: string, cap: Cap) => Shape} */
export function newShape(uid, cap) {
  return withCap({ uid, cap, revision: 0, deleted: false, whole: null, centre: null, score: null, checked: true, doubt: 0 }, cap);
}

/** @type {(annotation: Annotation, checked?: boolean) => Shape} */
export function shapeOfAnnotation(annotation, checked = true) {
  const { uid, cap, revision, deleted, whole, centre, centre_sd: sd } = annotation;
  const doubt = doubtOf(annotation);
  return { uid, cap, revision, deleted, whole, centre, score: null, checked, doubt, sd };
}

/** A centre that may be so far off, of the diameter, is worth every look. */
const WORST_CENTRE = 0.1;

/** By how well the centre is known; a cap whose centre nobody knows is worth a look. @type {(annotation: Annotation) => number} */
function doubtOf({ whole, centre_sd }) {
  if (!whole || !centre_sd) return 1;
  const { a, b } = axesOf(whole);
  return Math.min(1, Math.hypot(...centre_sd) / (2 * Math.sqrt(a * b)) / WORST_CENTRE);
}

/** @type {(prediction: Prediction) => Shape} */
export function shapeOfPrediction({ id, visible, category, whole, centre, score, quality, extra }) {
  return {
    uid: uidOfPrediction(id),
    cap: { visible, mark: null, ignored: false, doubtful: false, order: null, category, prediction: id },
    revision: 0,
    deleted: false,
    whole,
    centre,
    score,
    checked: false,
    doubt: 1 - (quality ?? score),
    sd: pairOf(extra.center_sd),
  };
}

/** @type {(value: unknown) => Point | null} */
function pairOf(value) {
  return Array.isArray(value) && value.length === 2 ? [Number(value[0]), Number(value[1])] : null;
}

/** @type {(id: number) => string} */
export function uidOfPrediction(id) {
  return `prediction:${id}`;
}

/** @type {(uid: string) => boolean} */
export function isUidOfPrediction(uid) {
  return uid.startsWith("prediction:");
}

/** @type {(shape: Shape) => boolean} */
export function isPrediction(shape) {
  return shape.score !== null;
}

/** @type {(shape: Shape, dx: number, dy: number) => Shape} */
export function movedShape(shape, dx, dy) {
  const cap = movedCap(shape.cap, dx, dy);
  const { centre } = shape;
  return {
    ...shape,
    cap,
    whole: movedWhole(shape.whole, dx, dy),
    centre: centre && [centre[0] + dx, centre[1] + dy],
  };
}

/**
 * The same shape with another cap; a circle a person placed is its own whole outline.
 *
 * @param {Shape} shape
 * @param {Cap} cap
 * @returns {Shape}
 */
export function withCap(shape, cap) {
  const placed = placedWhole(cap);
  return placed ? { ...shape, cap, whole: placed, centre: [placed.cx, placed.cy] } : { ...shape, cap };
}

/** Around what was drawn by hand or seen, else around the whole outline. @type {(shape: Shape) => Bounds | null} */
export function boundsOf({ cap, whole }) {
  return measure(cap).bounds ?? (whole && boundsOfWhole(whole));
}

/** Around everything of it that may be drawn, the whole outline too. @type {(shape: Shape) => Bounds | null} */
export function reachOf({ cap, whole }) {
  const { bounds } = measure(cap);
  if (!whole) return bounds;
  return bounds ? joined(bounds, boundsOfWhole(whole)) : boundsOfWhole(whole);
}
