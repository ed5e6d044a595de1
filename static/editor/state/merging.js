import { areaOf } from "../geometry/regions.js";
import { mergedOutline } from "../geometry/cuts.js";
import { isPrediction, withCap } from "../geometry/shapes.js";
import { changed } from "./changes.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./changes.js").Change} Change */

/**
 * The changes that make one cap of several: of the largest that people agreed on, else of the largest
 * prediction. It keeps its mark, or gets the one that any of the others has. The kept one's change comes first.
 *
 * @param {Shape[]} shapes  two or more, all of which show something
 * @returns {Change[]}
 */
export function merged(shapes) {
  const [kept, ...others] = shapes.toSorted(
    (a, b) => Number(isPrediction(a)) - Number(isPrediction(b)) || areaOf(b.cap.visible) - areaOf(a.cap.visible),
  );
  const visible = mergedOutline(shapes.map(({ cap }) => cap));
  const mark = kept.cap.mark ?? others.find(({ cap }) => cap.mark)?.cap.mark ?? null;
  const arcs = shapes.flatMap(({ cap }) => cap.arcs ?? []);
  const cap = { ...kept.cap, visible, mark, ...(arcs.length && { arcs }) };
  return [
    changed(kept, withCap(kept, cap)),
    ...others.map((shape) => changed(shape, { ...shape, deleted: true })),
  ];
}
