/**
 * A press that is under way: what it does to caps it does to them as they were when it began.
 *
 * @module
 */

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("./changes.js").Change} Change */

export class Gesture {
  /** The revisions of all caps when it began. @type {Map<string, number>} */
  #revisions = new Map();

  /** @type {(shapes: Shape[]) => void} */
  begin(shapes) {
    this.#revisions = new Map(shapes.map(({ uid, revision }) => [uid, revision]));
  }

  end() {
    this.#revisions.clear();
  }

  /** The changes as ones of the caps as they were when the gesture began; each cap is changed so once. @type {(changes: Change[]) => Change[]} */
  asBegun(changes) {
    const begun = changes.map((change) => this.#asBegun(change));
    for (const { after } of changes) this.#revisions.delete(after.uid);
    return begun;
  }

  /** @type {(change: Change) => Change} */
  #asBegun(change) {
    const { before } = change;
    const revision = before && this.#revisions.get(before.uid);
    return before && revision != null && revision < before.revision
      ? { ...change, before: { ...before, revision } }
      : change;
  }
}
