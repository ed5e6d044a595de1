/**
 * What a reviewer looks at on an image: where annotations and predictions differ, and how that is shown.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { boundsOf, isPrediction, uidOfPrediction, withCap } from "../geometry/shapes.js";
import { changed, heirsIn } from "./changes.js";
import { signal } from "./signal.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("./editor_state.js").EditorState} EditorState */

/**
 * @typedef {Object} WordsQuestion
 * @property {string} title
 * @property {string} question  what the words answer
 * @property {string} verb  of the buttons
 * @property {string[]} reasons  that can be chosen by number
 * @property {boolean} cap  whether a cap is selected
 * @property {"cap" | "image"} first  what Enter is about where one is
 */
/** @typedef {{about: "cap" | "image", words: string}} Said */

/** Outlines that are as like as this need no look. */
const ALIKE = 0.98;
/** How many times an error is drawn as long as it is, on request. */
const MAGNIFIED = 10;

export class Review {
  changed = signal();
  #on = false;
  #times = 1;
  /** @type {(() => void)[]} */
  #waiting = [];
  /** Which of the two is drawn while they take turns; null while both are. @type {"annotation" | "prediction" | null} */
  turn = null;
  /** The worst first. @type {ComparedCap[]} */
  caps = [];
  /** Those that the reviewer has decided, each with the cap as it is since; null where there is none. @type {Map<string, Shape | null>} */
  decided = new Map();
  /** The image that `caps` are of. */
  image = 0;

  get on() {
    return this.#on;
  }

  set on(on) {
    this.#on = on;
    this.changed.emit();
  }

  /** How many times as long as it is an error is drawn. */
  get times() {
    return this.#times;
  }

  /** Draws errors enlarged, or as they are again. */
  magnify() {
    this.#times = this.#times === 1 ? MAGNIFIED : 1;
    this.changed.emit();
  }

  /** What the server has found. @type {(image: number, caps: ComparedCap[]) => void} */
  take(image, caps) {
    if (image !== this.image) this.decided.clear();
    this.image = image;
    this.caps = caps;
    this.changed.emit();
    for (const go of this.#waiting.splice(0)) go();
  }

  /** Until the server has said what differs on an image. @type {(image: number) => Promise<void>} */
  async known(image) {
    if (this.image !== image) await new Promise((go) => this.#waiting.push(() => go(null)));
  }

  /** The predictions without a cap of an image, while a reviewer looks at it. @type {(image: number) => import("../protocol.js").Prediction[]} */
  extra(image) {
    if (!this.on || this.image !== image) return [];
    return this.caps.flatMap(({ annotation, prediction }) => (!annotation && prediction ? [prediction] : []));
  }

  /** What is compared with what is selected; null where nothing is. @type {(state: EditorState) => ComparedCap | null} */
  selected(state) {
    const uid = state.selection.soleUid;
    return this.caps.find((cap) => uid !== null && uidOf(cap) === uid) ?? null;
  }
}

/** Whether a reviewer has to look at it. @type {(cap: ComparedCap) => boolean} */
export function differs({ annotation, prediction, iou, cdr, floor }) {
  if (!annotation || !prediction) return true;
  return (iou ?? 1) < ALIKE || (cdr ?? 0) > (floor ?? 0);
}

/** The uid of the item on screen. @type {(cap: ComparedCap) => string} */
export function uidOf({ annotation, prediction }) {
  return annotation ?? uidOfPrediction(prediction?.id ?? 0);
}

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

/**
 * Decides on a cap that differs, and remembers what it is since; what stands for the same cap is decided with it.
 *
 * @type {(state: EditorState, review: Review, cap: ComparedCap, carryOut: () => void) => void}
 */
export function decideOn(state, review, cap, carryOut) {
  const partner = partnerOf(state, review, cap);
  carryOut();
  const heirs = heirsIn(state.store);
  for (const each of partner ? [cap, partner] : [cap]) {
    const { annotation, prediction } = each;
    const now = annotation ? state.store.get(annotation) : heirs.get(prediction?.id ?? 0);
    review.decided.set(uidOf(each), now ?? null);
  }
}

/**
 * Has a cap be as the network said: its outline without a mark, the prediction itself, or no cap. A cap that was moved
 * so far that nothing matches it goes back to the prediction that it started from.
 *
 * @type {(state: EditorState, review: Review, cap: ComparedCap) => void}
 */
export function takePrediction(state, review, cap) {
  const partner = partnerOf(state, review, cap);
  const uid = cap.annotation ?? partner?.annotation ?? uidOf(cap);
  const said = cap.prediction ?? partner?.prediction;
  const shape = state.items.get(uid);
  if (!shape) return;
  if (isPrediction(shape)) state.commit([changed(shape, shape)]);
  else if (!said) state.commit([changed(shape, { ...shape, deleted: true })]);
  else state.commit([changed(shape, withCap(shape, { ...shape.cap, visible: said.visible, mark: null }))]);
}

/** The prediction that a missed cap started from, where that is extra; and the other way round. @type {(state: EditorState, review: Review, cap: ComparedCap) => ComparedCap | null} */
export function partnerOf({ store }, { caps }, { annotation, prediction }) {
  if (annotation && prediction) return null;
  const heir = annotation ? store.get(annotation) : heirsIn(store).get(prediction?.id ?? 0);
  const isIt = (/** @type {ComparedCap} */ other) =>
    annotation ? !other.annotation && other.prediction?.id === heir?.cap.prediction : other.annotation === heir?.uid && !other.prediction;
  return heir ? (caps.find(isIt) ?? null) : null;
}
