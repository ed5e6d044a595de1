/**
 * From one state of a shape to the next, as plain values.
 *
 * @module
 */

import { boundsOfWhole, measure, movedCap, movedWhole, placedWhole } from "./caps.js";
import { movedHandle } from "./handles.js";
import { isPrediction } from "../state/store.js";
import { newId } from "../sync/outbox_owner.js";

/** @typedef {import("./handles.js").Handle} Handle */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/store.js").Change} Change */
/** @typedef {import("../state/store.js").Shape} Shape */
/** @typedef {import("./view.js").Bounds} Bounds */

/**
 * Moves a handle by a fraction of a pixel; right and up make a circle larger.
 *
 * @param {Cap} cap
 * @param {Handle} handle
 * @param {number} dx
 * @param {number} dy
 * @returns {Cap}
 */
export function nudgedHandle(cap, handle, dx, dy) {
  const mark = placedWhole(cap);
  /** @type {Point} */
  const from = mark ? [boundsOfWhole(mark).x1, mark.cy] : [0, 0];
  const by = handle.kind === "rim" ? { dx: dx - dy, dy: 0 } : { dx, dy };
  return movedHandle(cap, handle, { ...by, from, pull: 0 });
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

/**
 * The change from an item to what it became. A prediction is never changed: an annotation that started
 * from it takes its place.
 *
 * @param {Shape} before
 * @param {Shape} after
 * @returns {Change}
 */
export function changed(before, after) {
  if (!isPrediction(before)) return { before, after };
  return { before: null, after: { ...after, uid: newId(), revision: 0, score: null } };
}

/** @type {(shape: Shape) => Bounds | null} */
export function boundsOf({ cap, whole }) {
  return measure(cap).bounds ?? (whole && boundsOfWhole(whole));
}
