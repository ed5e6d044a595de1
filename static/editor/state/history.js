/**
 * Undo and redo of one image, without limit: change sets and their inverses.
 *
 * @module
 */

import { inverse } from "./changes.js";
import { untouched } from "./untouched.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./changes.js").Change} Change */

export class History {
  /** @type {Change[][]} */
  #done = [];
  /** @type {Change[][]} */
  #undone = [];

  /**
   * Something new was done; what was taken back of other caps can still be done again.
   *
   * @type {(changes: Change[]) => void}
   */
  push(changes) {
    this.#done.push(changes);
    this.#undone = untouched(this.#undone, (set) => set, changes);
  }

  /**
   * What to apply to take back the last change set; null when there is none.
   *
   * @param {(uid: string) => Shape | null} current
   * @returns {Change[] | null}
   */
  undo(current) {
    const changes = this.#done.pop();
    if (!changes) return null;
    this.#undone.push(changes);
    return onTopOf(inverse(changes), current);
  }

  /**
   * What to apply to do again what was taken back last; null when there is nothing.
   *
   * @param {(uid: string) => Shape | null} current
   * @returns {Change[] | null}
   */
  redo(current) {
    const changes = this.#undone.pop();
    if (!changes) return null;
    this.#done.push(changes);
    return onTopOf(changes, current);
  }

  /**
   * Somebody else changed these caps: undoing ours would silently undo theirs.
   *
   * @param {Set<string>} uids
   */
  forget(uids) {
    const without = (/** @type {Change[][]} */ sets) =>
      sets.map((set) => set.filter(({ after }) => !uids.has(after.uid))).filter((set) => set.length > 0);
    this.#done = without(this.#done);
    this.#undone = without(this.#undone);
  }

  get depth() {
    return { undo: this.#done.length, redo: this.#undone.length };
  }
}

/**
 * The same changes made on the shapes as they are now, whose revisions have moved on.
 *
 * @param {Change[]} changes
 * @param {(uid: string) => Shape | null} current
 * @returns {Change[]}
 */
function onTopOf(changes, current) {
  return changes.map(({ after }) => {
    const before = current(after.uid);
    return { before, after: { ...after, revision: before?.revision ?? 0 } };
  });
}
