/**
 * Colours of caps by a figure, from bad to good. The ramp runs from orange over pale to blue, which colour-blind
 * eyes tell apart, and what is bad is drawn with a wider line as well.
 *
 * @module
 */

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../state/photo_look.js").Look["colouring"]} Colouring */

export const RAMP = ["#ff6a3d", "#ffb26b", "#fff0b8", "#9fd8ff", "#4fb0ff"];
const WIDEST = 3.5;
const USUAL = 1.5;
/** Scores from here on are shown; worse an outline is as bad as any; and from here on a centre is no longer known, in diameters. */
const LEAST_SCORE = 0.3;
const LEAST_QUALITY = 0.5;
const UNSURE = 0.05;

/** What the ends of the ramp mean. @type {Record<Exclude<Colouring, "none">, [string, string]>} */
export const ENDS = {
  score: [`score ${LEAST_SCORE}`, "score 1"],
  quality: [`IoU ${LEAST_QUALITY} expected`, "IoU 1"],
  sure: [`centre ± ${100 * UNSURE} % of the width and more`, "± 0 %"],
};

/** How good a cap is by this figure, 0 to 1; null where that is not known. @type {(shape: Shape, by: Colouring) => number | null} */
export function goodness({ score, doubt, sd, whole }, by) {
  if (by === "score") return score === null ? null : above(LEAST_SCORE, score);
  // Of an open prediction that is what its outline is expected to miss; what people agreed on has no such figure.
  if (by === "quality") return score === null ? null : above(LEAST_QUALITY, 1 - doubt);
  if (by !== "sure" || !sd || !whole) return null;
  const width = 2 * (whole.kind === "circle" ? whole.r : Math.sqrt(whole.a * whole.b));
  return clamped(1 - Math.max(...sd) / width / UNSURE);
}

/** @type {(goodness: number) => {colour: string, width: number}} */
export function lineOf(goodness) {
  const colour = RAMP[Math.min(Math.floor(goodness * RAMP.length), RAMP.length - 1)];
  return { colour, width: USUAL + (1 - goodness) * (WIDEST - USUAL) };
}

/** Where a figure lies between the least that counts and 1. @type {(least: number, figure: number) => number} */
function above(least, figure) {
  return clamped((figure - least) / (1 - least));
}

/** @type {(value: number) => number} */
function clamped(value) {
  return Math.min(Math.max(value, 0), 1);
}
