/**
 * Undo and redo of one image, without limit: what was done in one go, and its inverse.
 *
 * @module
 */

import { inverse } from "./changes.js";
import { untouched } from "./untouched.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Status} Status */
/** @typedef {import("./changes.js").Change} Change */
/** @typedef {{before: Status, after: Status}} StatusChange */
/** What a reviewer said of a cap, or of the image where `annotation` is null. @typedef {import("../protocol.js").VerdictToWithdraw} VerdictToWithdraw */

/**
 * What was done in one go.
 *
 * @typedef {Object} ChangeSet
 * @property {string[]} ids  the change sets that did it, took it back, did it again …; the newest one last
 * @property {Change[]} changes
 * @property {StatusChange | null} status
 * @property {VerdictToWithdraw | null} [verdict]
 */

/**
 * What is to be done now, and the change set that this takes back.
 *
 * @typedef {{takesBack: string, changes: Change[], status: StatusChange | null, verdict?: VerdictToWithdraw | null}} Move
 */

export class History {
  /** @type {ChangeSet[]} */
  #done = [];
  /** @type {ChangeSet[]} */
  #undone = [];

  /**
   * Something new was done; what was taken back of other caps can still be done again.
   *
   * @type {(set: ChangeSet) => void}
   */
  push(set) {
    this.#done.push(set);
    this.#undone = untouched(this.#undone, ({ changes }) => changes, set.changes);
  }

  /** Takes in what was done before this page was loaded, and is taken back now. @type {(set: ChangeSet) => void} */
  wasUndone(set) {
    this.#undone.push(set);
  }

  /** Takes in what was taken back before this page was loaded, and is done again now. @type {(set: ChangeSet) => void} */
  wasRedone(set) {
    this.#done.push(set);
  }

  /**
   * What to do to take back the last set; null when there is none.
   *
   * @param {string} id  of the change set that does it
   * @param {(uid: string) => Shape | null} current
   * @returns {Move | null}
   */
  undo(id, current) {
    const set = this.#done.pop();
    if (!set) return null;
    this.#undone.push({ ...set, ids: [...set.ids, id] });
    return backwards(set, current);
  }

  /**
   * What to do to do again what was taken back last; null when there is nothing.
   *
   * @param {string} id  of the change set that does it
   * @param {(uid: string) => Shape | null} current
   * @returns {Move | null}
   */
  redo(id, current) {
    const set = this.#undone.pop();
    if (!set) return null;
    this.#done.push({ ...set, ids: [...set.ids, id] });
    return { takesBack: newest(set), changes: onTopOf(set.changes, current), status: set.status, verdict: (!set.status && set.verdict) || null };
  }

  /**
   * Somebody else changed these caps: undoing ours would silently undo theirs.
   *
   * @param {Set<string>} uids
   */
  forget(uids) {
    this.#mend((set) => ({ ...set, changes: set.changes.filter(({ after }) => !uids.has(after.uid)) }));
  }

  /** Somebody else said something else of the image. */
  forgetStatus() {
    this.#mend((set) => ({ ...set, status: null, verdict: set.verdict?.annotation ? set.verdict : null }));
  }

  /**
   * A change was refused: it never was, and what was done after it was done to the cap as it is without it.
   *
   * @param {string} changeSet
   * @param {string} uid
   * @param {(cap: Cap) => Cap} without  a cap as it would be if the refused change had never been
   */
  refused(changeSet, uid, without) {
    const isIt = (/** @type {ChangeSet} */ set) => set.ids.includes(changeSet);
    const place = this.#done.findIndex(isIt);
    const undone = this.#undone.findIndex(isIt);
    const later = [...(place < 0 ? [] : this.#done.slice(place + 1)), ...this.#undone.slice(0, undone < 0 ? undefined : undone)];
    const mended = new Set(later.filter((set) => set.ids[0] !== changeSet));
    this.#mend((set) => {
      if (isIt(set)) return { ...set, changes: set.changes.filter(({ after }) => after.uid !== uid) };
      return mended.has(set) ? { ...set, changes: set.changes.map((change) => mendedChange(change, uid, without)) } : set;
    });
  }

  /** A change of status was refused. @type {(changeSet: string) => void} */
  refusedStatus(changeSet) {
    this.#mend((set) => (set.ids.includes(changeSet) ? { ...set, status: null, verdict: null } : set));
  }

  /** @type {(mend: (set: ChangeSet) => ChangeSet) => void} */
  #mend(mend) {
    const mended = (/** @type {ChangeSet[]} */ sets) =>
      sets.map(mend).filter(({ changes, status, verdict }) => changes.length > 0 || status || verdict);
    this.#done = mended(this.#done);
    this.#undone = mended(this.#undone);
  }

  /** Whether what was done last was to say something of the image. */
  get endsInStatus() {
    const last = this.#done.at(-1);
    return Boolean(last && (last.status || last.verdict?.annotation === null));
  }

  get depth() {
    return { undo: this.#done.length, redo: this.#undone.length };
  }
}

/** What takes a set back. @type {(set: ChangeSet, current: (uid: string) => Shape | null) => Move} */
export function backwards(set, current) {
  const { changes, status, verdict } = set;
  return {
    takesBack: newest(set),
    changes: onTopOf(inverse(changes), current),
    status: status && { before: status.after, after: status.before },
    // With the status of an image the server withdraws what was said of it.
    verdict: verdict && !status ? { ...verdict, says: "withdrawn", words: "" } : null,
  };
}

/** @type {(set: ChangeSet) => string} */
function newest({ ids }) {
  return ids[ids.length - 1];
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

/** @type {(change: Change, uid: string, without: (cap: Cap) => Cap) => Change} */
function mendedChange(change, uid, without) {
  if (change.after.uid !== uid) return change;
  const mended = (/** @type {Shape} */ shape) => ({ ...shape, cap: without(shape.cap) });
  return { before: change.before && mended(change.before), after: mended(change.after) };
}
