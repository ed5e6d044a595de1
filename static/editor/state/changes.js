/**
 * Changes of shapes as plain values: what is committed, undone and sent.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { isPrediction } from "../geometry/shapes.js";
import { newId } from "../ids.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {{before: Shape | null, after: Shape}} Change  `before` is null for a cap that is new */

/**
 * The change from a shape to what it became. A prediction is never changed: an annotation that started
 * from it takes its place.
 *
 * @param {Shape} before
 * @param {Shape} after
 * @returns {Change}
 */
export function changed(before, after) {
  if (!isPrediction(before)) return { before, after: { ...after, checked: true } };
  return { before: null, after: { ...after, uid: newId(), revision: 0, score: null, checked: true } };
}

/**
 * The changes that take these back, in reverse order. Taking back a creation deletes the cap and gives
 * its prediction free, so that it is open again.
 *
 * @param {Change[]} changes
 * @returns {Change[]}
 */
export function inverse(changes) {
  return changes.map(({ before, after }) => ({ before: after, after: before ?? released(after) })).reverse();
}

/** @type {(shape: Shape) => Shape} */
function released(shape) {
  return { ...shape, deleted: true, cap: { ...shape.cap, prediction: null } };
}

/**
 * The caps to send one after the other so that the server ends where the change does; null deletes.
 *
 * @param {Change} change
 * @returns {(Cap | null)[]}
 */
export function stepsOf({ before, after }) {
  if (!after.deleted) return [after.cap];
  const known = before !== null && !before.deleted && same(before.cap, after.cap);
  return known ? [null] : [after.cap, null];
}
