/**
 * Caps as they would become: shown while they are being dragged or nudged, and not committed yet.
 *
 * @module
 */

/** @typedef {import("../geometry/shapes.js").Shape} Shape */

export class Drafts {
  /** @type {Map<string, Shape>} */
  #shapes = new Map();
  /** What they were when they were begun. @type {Map<string, Shape>} */
  #begun = new Map();
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

  /**
   * @param {Shape} shape
   * @param {Shape | null} [now]  the item that it is a draft of, as it is now
   */
  put(shape, now = null) {
    this.#shapes.set(shape.uid, shape);
    if (now && !this.#begun.has(shape.uid)) this.#begun.set(shape.uid, now);
  }

  /**
   * What a draft was begun on. Whatever has become of the cap since, the draft keeps the revision that it was
   * made of: only so can the server tell that two people have changed the cap at once.
   *
   * @param {Shape} draft
   * @returns {Shape | null}
   */
  begunOn(draft) {
    const begun = this.#begun.get(draft.uid);
    return begun ? { ...begun, revision: draft.revision } : null;
  }

  /** Forgets them all. @returns {{before: Shape | null, draft: Shape}[]} what they were, and begun on */
  clear() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    const pairs = this.all.map((draft) => ({ before: this.begunOn(draft), draft }));
    this.#shapes.clear();
    this.#begun.clear();
    return pairs;
  }

  /** Calls `commit` when nothing more has happened for a while. @type {(wait_ms: number, commit: () => void) => void} */
  commitAfter(wait_ms, commit) {
    clearTimeout(this.#timer);
    this.#timer = setTimeout(commit, wait_ms);
  }
}
