/**
 * What a reviewer looks at on an image: where annotations and predictions differ, and how that is shown.
 *
 * @module
 */

import { boundsOf, uidOfPrediction, withCap } from "../geometry/shapes.js";
import { changed } from "./changes.js";
import { signal } from "./signal.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("./editor_state.js").EditorState} EditorState */

/** @typedef {{question: string, cap: boolean, first: "cap" | "image"}} WordsQuestion  whether a cap is selected, and what Enter is about if so */
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
  /** Those that the reviewer has decided. @type {Set<string>} */
  decided = new Set();
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

/**
 * What is next to be looked at, from what is selected on; null where nothing is.
 *
 * @type {(state: EditorState, review: Review, by: 1 | -1) => string | null}
 */
export function nextOf(state, review, by) {
  const here = state.selection.soleUid;
  const all = review.caps.filter(differs).map(uidOf).filter((uid) => state.items.get(uid));
  const uids = all.filter((uid) => uid === here || !review.decided.has(uid));
  const at = uids.indexOf(here ?? "");
  const next = at < 0 ? (by === 1 ? 0 : uids.length - 1) : (at + by + uids.length) % uids.length;
  return uids.length === 0 || uids[next] === here ? null : uids[next];
}

/** Selects a cap and brings it into view. @type {(state: EditorState, uid: string) => void} */
export function lookAt(state, uid) {
  const shape = state.items.get(uid);
  if (!shape) return;
  state.select([uid]);
  const bounds = boundsOf(shape);
  if (bounds) state.viewport.centre(bounds);
}

/**
 * Has a cap be as the network said: its outline without a mark, the prediction itself, or no cap.
 *
 * @type {(state: EditorState, shape: Shape, cap: ComparedCap) => void}
 */
export function takePrediction(state, shape, { annotation, prediction }) {
  if (!annotation) state.commit([changed(shape, shape)]);
  else if (!prediction) state.commit([changed(shape, { ...shape, deleted: true })]);
  else state.commit([changed(shape, withCap(shape, { ...shape.cap, visible: prediction.visible, mark: null }))]);
}
