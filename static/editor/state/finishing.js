/**
 * What is asked before an image is finished: while caps on it are open, while there are none at all, and where
 * outlines drawn by hand have few points.
 *
 * @module
 */

/** @typedef {"yes" | "no" | "down"} Answer  as it is; not now; after what is open has been turned down */
/** @typedef {{text: string, yes: string, no: string, down: string | null}} Question */

/**
 * @typedef {Object} Counts
 * @property {string} name  of the image
 * @property {number} caps  annotations
 * @property {number} open  predictions neither accepted nor turned down
 * @property {number} unchecked  annotations that a file said and nobody has looked at
 * @property {number} coarse  outlines drawn by hand of fewer points than they should have
 */

/** Null where there is nothing to ask. @type {(status: "annotated" | "approved", counts: Counts) => Question | null} */
export function questionOf(status, counts) {
  const { name, caps, open, unchecked, coarse } = counts;
  if (caps === 0 && open === 0)
    return {
      text: `${name} has no cap at all. Is it empty? As “${status}” it teaches that there is none to be found.`,
      yes: "It is empty",
      no: "Go back",
      down: null,
    };
  // What a file said was said by somebody: by itself it is no reason to ask.
  if (open === 0 && coarse === 0) return null;
  const found = [...ofOpen(counts), ...ofUnchecked(unchecked), ...ofCoarse(coarse)];
  const means = open === 0 ? "" : caps === 0 ? ", it counts as a photo without a single cap" : meaning(open);
  return {
    text: `${name} has ${inWords(found)}. Set to “${status}” as it is${means || ", they stay as they are"}.`,
    yes: `Set to “${status}” all the same`,
    no: "Go back",
    down: open === 0 ? null : open === 1 ? "Turn it down first" : `Turn the ${open} down first`,
  };
}

/** @type {(open: number) => string} */
function meaning(open) {
  return `, what ${open === 1 ? "it shows" : "they show"} counts as no cap`;
}

/** @type {(counts: Counts) => string[]} */
function ofOpen({ open, caps }) {
  if (open === 0) return [];
  const predictions = open === 1 ? "one prediction that is" : `${open} predictions that are`;
  const annotations = caps === 0 ? "no annotation" : caps === 1 ? "one annotation" : `${caps} annotations`;
  return [`${predictions} neither accepted nor turned down`, annotations];
}

/** @type {(unchecked: number) => string[]} */
function ofUnchecked(unchecked) {
  if (unchecked === 0) return [];
  return [unchecked === 1 ? "one imported cap that nobody has checked" : `${unchecked} imported caps that nobody has checked`];
}

/** @type {(coarse: number) => string[]} */
function ofCoarse(coarse) {
  if (coarse === 0) return [];
  const outlines = coarse === 1 ? "one outline" : `${coarse} outlines`;
  return [`${outlines} of fewer points than 10, 20 or 25 (small, medium, large)`];
}

/** @type {(parts: string[]) => string} */
function inWords(parts) {
  return parts.length < 2 ? parts.join("") : `${parts.slice(0, -1).join(", ")}, and ${parts[parts.length - 1]}`;
}
