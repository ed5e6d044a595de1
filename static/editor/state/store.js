/**
 * The caps of the image on screen: an observable map of shapes by uid. Everything that happens to them is
 * a list of changes, and undoing is applying the inverse list.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").Prediction} Prediction */
/** @typedef {import("../protocol.js").Whole} Whole */

/**
 * One cap as drawn; never changed in place.
 *
 * @typedef {Object} Shape
 * @property {string} uid
 * @property {Cap} cap
 * @property {number} revision  of the server's that it was made on; 0 before the server knows the cap
 * @property {boolean} deleted
 * @property {Whole | null} whole
 * @property {Point | null} centre
 * @property {number | null} score  of a prediction; null for what people agreed on
 */

/** @typedef {{before: Shape | null, after: Shape}} Change */
/** @typedef {"local" | "remote"} Origin */
/** @typedef {(changes: Change[], origin: Origin) => void} Listener */

export class Store {
  /** @type {Map<string, Shape>} */
  #shapes = new Map();
  /** @type {Set<Listener>} */
  #listeners = new Set();

  /** @type {(uid: string) => Shape | null} */
  get(uid) {
    return this.#shapes.get(uid) ?? null;
  }

  /** Every shape, deleted ones too: they say which predictions were turned down. */
  all() {
    return [...this.#shapes.values()];
  }

  live() {
    return this.all().filter((shape) => !shape.deleted);
  }

  /** @type {(changes: Change[], origin: Origin) => void} */
  apply(changes, origin) {
    for (const { after } of changes) this.#shapes.set(after.uid, after);
    for (const listener of this.#listeners) listener(changes, origin);
  }

  /**
   * Starts over with the shapes of another image.
   *
   * @param {Shape[]} shapes
   */
  replace(shapes) {
    this.#shapes = new Map(shapes.map((shape) => [shape.uid, shape]));
  }

  /** @type {(listener: Listener) => () => void} */
  observe(listener) {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
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
  const known = before !== null && (before.cap === after.cap || sameCap(before.cap, after.cap));
  if (!after.deleted) return [after.cap];
  return known && !before.deleted ? [null] : [after.cap, null];
}

/** @type {(a: Cap, b: Cap) => boolean} */
export function sameCap(a, b) {
  return JSON.stringify(a) === JSON.stringify(b);
}

/** @type {(annotation: Annotation) => Shape} */
export function shapeOfAnnotation({ uid, cap, revision, deleted, whole, centre }) {
  return { uid, cap, revision, deleted, whole, centre, score: null };
}

/** @type {(prediction: Prediction) => Shape} */
export function shapeOfPrediction({ id, visible, category, whole, centre, score }) {
  return {
    uid: `prediction:${id}`,
    cap: { visible, mark: null, ignored: false, doubtful: false, order: null, category, prediction: id },
    revision: 0,
    deleted: false,
    whole,
    centre,
    score,
  };
}

/** @type {(shape: Shape) => boolean} */
export function isPrediction(shape) {
  return shape.score !== null;
}
