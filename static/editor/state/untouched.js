/** @typedef {import("./changes.js").Change} Change */

/**
 * Of what was taken back, what can still be done again after a new change: what concerns other caps and
 * predictions. What was to be done again after something that cannot be, and concerns the same, cannot either.
 *
 * @template T
 * @param {T[]} steps  the next to be done again last
 * @param {(step: T) => Change[]} changesOf
 * @param {Change[]} made
 * @returns {T[]}
 */
export function untouched(steps, changesOf, made) {
  const touched = new Set(made.flatMap(concerned));
  return steps
    .toReversed()
    .filter((step) => {
      const names = changesOf(step).flatMap(concerned);
      const free = !names.some((name) => touched.has(name));
      if (!free) for (const name of names) touched.add(name);
      return free;
    })
    .reverse();
}

/** The cap and the prediction that a change is about. @type {(change: Change) => (string | number)[]} */
function concerned({ before, after }) {
  const predictions = [before?.cap.prediction ?? null, after.cap.prediction];
  return [after.uid, ...predictions.filter((prediction) => prediction !== null)];
}
