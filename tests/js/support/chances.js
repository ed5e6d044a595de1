/**
 * The same numbers for the same seed: `chance(n)` is a whole number below n, `between(low, high)` a real one.
 *
 * @param {number} seed
 */
export function chances(seed) {
  let state = seed >>> 0;
  const next = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  return {
    chance: (/** @type {number} */ n) => Math.floor(next() * n),
    between: (/** @type {number} */ low, /** @type {number} */ high) => low + (high - low) * next(),
  };
}
