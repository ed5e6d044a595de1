/**
 * Caps as they would become: shown while they are being dragged or nudged, and not committed yet.
 *
 * @module
 */

/** @typedef {import("../geometry/shapes.js").Shape} Shape */

export class Drafts {
  /** @type {Map<string, Shape>} */
  #shapes = new Map();
  #timer = 0;

  get all() {
    return [...this.#shapes.values()];
  }

  /** How many of them nobody holds any more: they are committed when the timer runs out. */
  get waiting() {
    return this.#timer ? this.#shapes.size : 0;
  }

  /** @type {(uid: string) => boolean} */
  has(uid) {
    return this.#shapes.has(uid);
  }

  /** @type {(uid: string) => Shape | null} */
  get(uid) {
    return this.#shapes.get(uid) ?? null;
  }

  /** @type {(shape: Shape) => void} */
  put(shape) {
    this.#shapes.set(shape.uid, shape);
  }

  /** Forgets them all. @returns {Shape[]} what they were */
  clear() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    const shapes = this.all;
    this.#shapes.clear();
    return shapes;
  }

  /** Calls `commit` when nothing more has happened for a while. @type {(wait_ms: number, commit: () => void) => void} */
  commitAfter(wait_ms, commit) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(commit, wait_ms);
  }
}
