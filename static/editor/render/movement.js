/**
 * Whether the photo is being moved on screen, and which way.
 *
 * @module
 */

/** @typedef {import("../geometry/view.js").View} View */

/** So long nothing must have moved for the photo to be at rest. */
const REST_MS = 140;

export class Movement {
  /** What is shown. @type {View | null} */
  #view = null;
  #movedAt = -Infinity;
  #timer = 0;
  #rested;

  /** @param {() => void} rested  the photo has come to rest */
  constructor(rested) {
    this.#rested = rested;
  }

  /**
   * Another frame shows this view.
   *
   * @type {(view: View) => {before: View, still: boolean}} the view of the frame before
   */
  follow(view) {
    const before = this.#view ?? view;
    this.#view = view;
    const now = performance.now();
    if (view !== before) {
      this.#movedAt = now;
      clearTimeout(this.#timer);
      this.#timer = window.setTimeout(this.#rested, REST_MS);
    }
    return { before, still: now - this.#movedAt >= REST_MS };
  }
}
