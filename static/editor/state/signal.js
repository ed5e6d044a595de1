/**
 * @template {unknown[]} T
 * @typedef {{listen: (listener: (...args: T) => void) => void, emit: (...args: T) => void}} Signal
 */

/**
 * Something others may wait for.
 *
 * @template {unknown[]} T
 * @returns {Signal<T>}
 */
export function signal() {
  /** @type {((...args: T) => void)[]} */
  const listeners = [];
  return {
    listen: (listener) => void listeners.push(listener),
    emit: (...args) => listeners.forEach((listener) => listener(...args)),
  };
}
