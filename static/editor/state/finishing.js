/**
 * What is asked before an image is finished on which predictions are still open.
 *
 * @module
 */

/** @typedef {{text: string, yes: string, no: string}} Question */

/** @type {(status: "annotated" | "approved", counts: {name: string, open: number, caps: number}) => Question} */
export function questionOf(status, { name, open, caps }) {
  const predictions = open === 1 ? "one prediction that is" : `${open} predictions that are`;
  const annotations = caps === 0 ? "no annotation" : caps === 1 ? "one annotation" : `${caps} annotations`;
  const means =
    caps === 0
      ? "it counts as a photo without a single cap"
      : `what ${open === 1 ? "it shows" : "they show"} counts as no cap`;
  return {
    text: `${name} has ${predictions} neither accepted nor turned down, and ${annotations}. Set to “${status}” as it is, ${means}.`,
    yes: `Set to “${status}” all the same`,
    no: "Go back",
  };
}
