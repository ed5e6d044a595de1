/**
 * What is seen of a cap whose whole outline is known: that, less what lies in front of it.
 *
 * @module
 */

import { areaOf, shared, without, withoutFingers } from "./regions.js";
import { isPrediction } from "./shapes.js";

/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("./shapes.js").Shape} Shape */
/** @typedef {import("./view.js").Size} Size */

/** A cap of which so much lies on another is not under it, but upon it: a bud. */
const UPON = 0.9;
/** A prediction that overlaps so well, IoU, is of the same cap and hides nothing of it. */
const SAME = 0.5;
/** A splinter of less than this share of all is left out, */
const LEAST_SHARE = 0.04;
/** and between neighbours a finger that is thinner than this share of the radius. */
const LEAST_WIDTH = 0.15;

/**
 * @param {number[]} ring  the whole outline
 * @param {Shape[]} others  the caps around it
 * @param {Size} photo
 * @returns {{visible: Outline, order: number | null}} and where it lies in the overlap, if it lies upon another
 */
export function seenOf(ring, others, { width, height }) {
  const all = shared([ring], [[0, 0, width, 0, width, height, 0, height]]);
  const size = areaOf(all);
  let visible = all;
  /** @type {number | null} */
  let order = null;
  for (const { cap, ...shape } of others) {
    if (cap.visible.length === 0) continue;
    const covered = areaOf(shared(all, cap.visible));
    if (covered >= UPON * size) order = Math.max(order ?? 0, (cap.order ?? 0) + 1);
    else if (!isPrediction({ cap, ...shape }) || covered < SAME * (size + areaOf(cap.visible) - covered))
      visible = without(visible, cap.visible);
  }
  const parts = visible === all ? all : withoutFingers(visible, LEAST_WIDTH * Math.sqrt(size / Math.PI));
  return { visible: parts.filter((part) => areaOf([part]) >= LEAST_SHARE * size), order };
}
