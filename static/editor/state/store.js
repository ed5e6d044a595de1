/**
 * The annotations of the image on screen, by uid; says what changes.
 *
 * @module
 */

import { signal } from "./signal.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./changes.js").Change} Change */

export class Store {
  /** @type {Map<string, Shape>} */
  #shapes = new Map();
  /** Another number whenever any shape is another. */
  version = 0;
  /** @type {import("./signal.js").Signal<[Change[]]>} */
  changed = signal();

  /** @type {(uid: string) => Shape | null} */
  get(uid) {
    return this.#shapes.get(uid) ?? null;
  }

  /** Every shape, deleted ones too: they say which predictions were turned down. */
  all() {
    return [...this.#shapes.values()];
  }

  live() {
    return this.all().filter((shape) => !shape.deleted);
  }

  /** @type {(changes: Change[]) => void} */
  apply(changes) {
    for (const { after } of changes) this.#shapes.set(after.uid, after);
    this.version++;
    this.changed.emit(changes);
  }

  /**
   * Starts over with the shapes of another image; that is no change of any of them.
   *
   * @param {Shape[]} shapes
   */
  replace(shapes) {
    this.#shapes = new Map(shapes.map((shape) => [shape.uid, shape]));
    this.version++;
  }
}
