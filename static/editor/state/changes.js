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
/** @typedef {import("./store.js").Store} Store */
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
 * The same changes for a store in which a prediction stands for one cap at most. Where somebody turned it down, the
 * cap that says so comes back; where it is a cap already, what is made of it is one that started from nothing. To
 * turn down what is decided already changes nothing.
 *
 * @param {Change[]} changes
 * @param {Store} store
 * @returns {Change[]}
 */
export function madeApart(changes, store) {
  if (!changes.some(startsFromPrediction)) return changes;
  const held = heirsIn(store);
  return changes.flatMap((change) => {
    const { after } = change;
    const heir = startsFromPrediction(change) ? held.get(after.cap.prediction) : undefined;
    if (!heir) return [change];
    if (after.deleted) return [];
    if (heir.deleted) return [{ before: heir, after: { ...after, uid: heir.uid, revision: heir.revision } }];
    return [{ before: null, after: { ...after, cap: { ...after.cap, prediction: null } } }];
  });
}

/** What became of each prediction that somebody has decided upon; a live cap rather than one that was deleted. @type {(store: Store) => Map<number | null, Shape>} */
export function heirsIn(store) {
  const all = store.all().filter(({ cap }) => cap.prediction !== null);
  const heirs = [...all.filter(({ deleted }) => deleted), ...all.filter(({ deleted }) => !deleted)];
  return new Map(heirs.map((shape) => [shape.cap.prediction, shape]));
}

/** @type {(change: Change) => boolean} */
function startsFromPrediction({ before, after }) {
  return before === null && after.cap.prediction !== null;
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
