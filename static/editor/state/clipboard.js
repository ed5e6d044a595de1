/**
 * Caps that were copied, and those of the photo that was shown before: to be put down again, also on another
 * photo.
 *
 * @module
 */

import { joinedAll } from "../geometry/bounds.js";
import { hundredths, movedCap, newCap } from "../geometry/caps.js";
import { boundsOf, isPrediction, newShape } from "../geometry/shapes.js";
import { newId } from "../ids.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./changes.js").Change} Change */
/** @typedef {{shapes: Shape[], image: number}} Copied */

export class Clipboard {
  /** @type {Copied | null} */
  #copied = null;
  /** The caps of the photo that was shown last. @type {Copied | null} */
  #before = null;

  /** @type {(shapes: Shape[], image: number) => void} */
  copy(shapes, image) {
    this.#copied = { shapes, image };
  }

  /** Another photo comes: these were the caps of the one that goes. @type {(shapes: Shape[], image: number) => void} */
  leave(shapes, image) {
    this.#before = { shapes: shapes.filter((shape) => !isPrediction(shape)), image };
  }

  /**
   * What was copied as new caps: with its middle at a point of the photo that it comes from, at its own place on
   * another, as photos of one bed show one cap at one place.
   *
   * @type {(image: number, at: Point) => Change[]}
   */
  paste(image, at) {
    const copied = this.#copied;
    if (!copied) return [];
    const bounds = joinedAll(copied.shapes.flatMap((shape) => boundsOf(shape) ?? []));
    if (copied.image !== image || !bounds) return newOnes(copied.shapes, 0, 0);
    const [dx, dy] = [at[0] - (bounds.x0 + bounds.x1) / 2, at[1] - (bounds.y0 + bounds.y1) / 2];
    return newOnes(copied.shapes, hundredths(dx), hundredths(dy));
  }

  /** The caps of the photo that was shown before this one, as new caps of this. @type {(image: number) => Change[]} */
  pasteBefore(image) {
    const before = this.#before;
    return before && before.image !== image ? newOnes(before.shapes, 0, 0) : [];
  }
}

/** @type {(shapes: Shape[], dx: number, dy: number) => Change[]} */
function newOnes(shapes, dx, dy) {
  return shapes.map(({ cap }) => {
    const { visible, mark, order, category, ignored, arcs } = movedCap(cap, dx, dy);
    const copy = newCap({ visible, mark, order, category, ignored, ...(arcs && { arcs }) });
    return { before: null, after: newShape(newId(), copy) };
  });
}
