/**
 * Where a reviewer is in the walk through all that differs.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { boundsOf, isPrediction } from "../geometry/shapes.js";
import { heirsIn } from "./changes.js";
import { differs, uidOf } from "./review.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("./editor_state.js").EditorState} EditorState */
/** @typedef {import("./review.js").Review} Review */

/** Where a reviewer is among all that differs: what is left of it, and how much is decided. */
export class Standing {
  /** The uids of what is left, the selected cap among it. @type {string[]} */
  left;
  /** The place of the selected cap in `left`; -1 where it is none of them. */
  at;
  /** How many are decided. */
  done;
  /** What was compared, the worst first. @type {string[]} */
  #all;

  /**
   * @param {EditorState} state
   * @param {Review} review
   */
  constructor(state, review) {
    const heirs = heirsIn(state.store);
    const decided = new Set([...review.decided.keys()].filter((uid) => isDecided(state, review, uid)));
    this.#all = review.caps.map(uidOf);
    this.left = review.caps
      .filter((cap) => differs(cap) && isStill(state, heirs, cap))
      .map(uidOf)
      .filter((uid) => !decided.has(uid));
    this.at = this.left.indexOf(state.selection.soleUid ?? "");
    this.done = decided.size;
  }

  get total() {
    return this.left.length + this.done;
  }

  /** What is next to be looked at from what is selected on; null where nothing is. @type {(by: 1 | -1) => string | null} */
  next(by) {
    const { left, at } = this;
    const next = at < 0 ? (by === 1 ? 0 : left.length - 1) : (at + by + left.length) % left.length;
    return left.length === 0 || next === at ? null : left[next];
  }

  /** What comes after one that is decided, else the first of what is left. @type {(uid: string) => string | null} */
  after(uid) {
    const later = new Set(this.#all.slice(this.#all.indexOf(uid) + 1));
    return this.left.find((each) => later.has(each)) ?? this.left[0] ?? null;
  }
}

/** Whether it is there as it was when it was compared, as far as this page knows. @type {(state: EditorState, heirs: Map<number | null, Shape>, cap: ComparedCap) => boolean} */
function isStill(state, heirs, { annotation, prediction }) {
  if (annotation) return state.items.get(annotation) !== null;
  const heir = prediction && heirs.get(prediction.id);
  return !heir || heir.deleted || !same(heir.cap.visible, prediction.visible);
}

/** Whether a cap is as the reviewer's decision left it. @type {(state: EditorState, review: Review, uid: string) => boolean} */
function isDecided({ store }, review, uid) {
  const then = review.decided.get(uid);
  const now = then && store.get(then.uid);
  return then === null || (Boolean(now) && same([now?.cap, now?.deleted], [then?.cap, then?.deleted]));
}

/** Selects a cap and brings it into view, also from a layer that is hidden. @type {(state: EditorState, uid: string) => void} */
export function lookAt(state, uid) {
  const shape = state.items.get(uid);
  if (!shape) return;
  if (!state.layers.show(shape)) state.layers.toggle(isPrediction(shape) ? "prediction" : "outline");
  state.select([uid]);
  const bounds = boundsOf(shape);
  if (bounds) state.viewport.centre(bounds);
}
