/**
 * What was done, in the words that the panel's history has for it: "drew a cap", "deleted 3 caps".
 *
 * @module
 */

import { same } from "../geometry/same.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** What a cap was and what it became; null where there was none. @typedef {{before: Shape | null, after: Shape | null}} Became */

/**
 * @param {Became[]} changes
 * @returns {string}  "" where nothing was
 */
export function wordsOfChanges(changes) {
  /** How many there are of each kind, the kinds in the order in which they occur. @type {Map<string, number>} */
  const counts = new Map();
  for (const change of changes) for (const words of kindsOf(change)) counts.set(words, (counts.get(words) ?? 0) + 1);
  return [...counts].map(([words, count]) => counted(words, count)).join(", ");
}

/** With one cap or prediction for the sign in it, or so many. @type {(words: string, count: number) => string} */
function counted(words, count) {
  return words.replace(/# (cap|prediction)/, (_, what) => (count === 1 ? `a ${what}` : `${count} ${what}s`));
}

/** @type {(change: Became) => string[]} */
function kindsOf({ before, after }) {
  const [was, is] = [isThere(before), isThere(after)];
  if (was && is) return differences(was.cap, is.cap);
  if (is) return [is.cap.prediction === null ? "drew # cap" : "accepted # prediction"];
  if (was) return ["deleted # cap"];
  return ["turned down # prediction"];
}

/** @type {(shape: Shape | null) => Shape | null} */
function isThere(shape) {
  return shape && !shape.deleted ? shape : null;
}

/** @type {(before: Cap, after: Cap) => string[]} */
function differences(before, after) {
  const kinds = [];
  if (!same(before.visible, after.visible)) kinds.push("changed the outline of # cap");
  if (!same(before.arcs ?? [], after.arcs ?? [])) kinds.push("called a piece of a rim something else");
  if (!same(before.mark, after.mark)) {
    const verb = after.mark === null ? "cleared" : before.mark === null ? "placed" : "moved";
    kinds.push(`${verb} the mark of # cap`);
  }
  for (const flag of /** @type {const} */ (["ignored", "doubtful"])) {
    if (before[flag] !== after[flag]) kinds.push(`set # cap to ${after[flag] ? "" : "not "}${flag}`);
  }
  if (before.order !== after.order) kinds.push("changed the overlap order of # cap");
  return kinds;
}
