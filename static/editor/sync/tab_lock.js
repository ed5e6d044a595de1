/**
 * Takes a lock for as long as the page lives. Where the browser has no locks every tab counts as alone.
 *
 * @param {string} name
 * @param {{wait_ms?: number}} [how]  for one that a page which is being left may still hold for a moment
 * @returns {Promise<boolean>} whether it was free
 */
export function lock(name, { wait_ms = 0 } = {}) {
  if (!navigator.locks) return Promise.resolve(true);
  const how = wait_ms ? { signal: AbortSignal.timeout(wait_ms) } : { ifAvailable: true };
  return new Promise((resolve) => {
    const held = navigator.locks.request(name, how, (taken) => {
      resolve(taken !== null);
      return taken && new Promise(() => {});
    });
    held.catch(() => resolve(false));
  });
}
