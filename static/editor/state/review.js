/**
 * What a reviewer looks at on an image: where annotations and predictions differ, and how that is shown.
 *
 * @module
 */

import { uidOfPrediction } from "../geometry/shapes.js";
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
  /** What the reviewer has decided, by image. @type {Map<number, Map<string, Shape | null>>} */
  #decided = new Map();
  /** The image that `caps` are of. */
  image = 0;
  /** What a second annotator's version is called, where its caps stand for predictions. @type {string | null} */
  second = null;

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

  /** The caps of the image that the reviewer has decided, each as it is since; null where there is none. @returns {Map<string, Shape | null>} */
  get decided() {
    let decided = this.#decided.get(this.image);
    if (!decided) this.#decided.set(this.image, (decided = new Map()));
    return decided;
  }

  /** What the server has found. @type {(image: number, caps: ComparedCap[], second?: string | null) => void} */
  take(image, caps, second = null) {
    this.image = image;
    this.caps = caps;
    this.second = second;
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
