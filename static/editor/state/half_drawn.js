/**
 * The outline that is being drawn on the image on screen: points that are placed, and those that were taken
 * back and can be placed again. It outlives the tool that draws it.
 *
 * @module
 */

import { signal } from "./signal.js";

/** @typedef {import("../protocol.js").Point} Point */

export class HalfDrawn {
  /** @type {Point[]} */
  #points = [];
  /** What was taken back, the latest last: single points, or all of them at once. @type {Point[][]} */
  #takenBack = [];
  /** Whether all of it was dropped by the step before. */
  #dropped = false;
  /** @type {import("./signal.js").Signal<[]>} */
  changed = signal();

  /** @returns {readonly Point[]} */
  get points() {
    return this.#points;
  }

  get empty() {
    return this.#points.length === 0;
  }

  /** Whether points that were taken back can be placed again. */
  get canRedo() {
    return this.#takenBack.length > 0;
  }

  /** @type {(point: Point) => void} */
  add(point) {
    this.#become([...this.#points, point], []);
  }

  /** Takes the last point back, or takes back that all were dropped. @returns {boolean} whether there was anything */
  undo() {
    if (this.#dropped) return this.redo();
    const last = this.#points.at(-1);
    if (!last) return false;
    this.#become(this.#points.slice(0, -1), [...this.#takenBack, [last]]);
    return true;
  }

  /** Places again what was taken back last. @returns {boolean} whether there was anything */
  redo() {
    const points = this.#takenBack.at(-1);
    if (!points) return false;
    this.#become([...this.#points, ...points], this.#takenBack.slice(0, -1));
    return true;
  }

  /** Drops all points; undo brings them back. */
  drop() {
    if (this.empty) return;
    this.#become([], [...this.#takenBack, this.#points]);
    this.#dropped = true;
  }

  /**
   * Goes on with these points; nothing of what was there before can be brought back.
   *
   * @type {(points: Point[]) => void}
   */
  begin(points) {
    if (this.empty && points.length === 0 && !this.canRedo) return;
    this.#become(points, []);
  }

  /** @type {(points: Point[], takenBack: Point[][]) => void} */
  #become(points, takenBack) {
    this.#points = points;
    this.#takenBack = takenBack;
    this.#dropped = false;
    this.changed.emit();
  }
}
