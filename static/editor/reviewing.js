/**
 * Keeps what a reviewer sees up to date: asks the server where annotations and predictions differ, draws it, and
 * has the two take turns.
 *
 * @module
 */

import { isUidOfPrediction } from "./geometry/shapes.js";
import { drawReview } from "./render/review_lines.js";
import { Review } from "./state/review.js";

/** @typedef {import("./protocol.js").Compared} Compared */
/** @typedef {import("./protocol.js").ToServer} ToServer */
/** @typedef {import("./state/editor_state.js").EditorState} EditorState */

const TURN_MS = 500;

export class Reviewing {
  review = new Review();
  #timer = 0;
  #state;
  #send;

  /**
   * @param {EditorState} state
   * @param {(message: ToServer) => unknown} send
   */
  constructor(state, send) {
    this.#state = state;
    this.#send = send;
    let was = false;
    this.review.changed.listen(() => {
      if (this.review.on && !was) this.ask();
      was = this.review.on;
      if (!was) this.#stay();
      state.reviewing = this.review.on;
      state.showBesides(this.review.extra(state.image?.id ?? 0));
      state.signals.overlay.emit();
    });
  }

  /** The image, or what is stored of it, is another now. */
  ask() {
    const { image } = this.#state;
    if (this.review.on && image) this.#send({ type: "compare", image: image.id });
  }

  /** @type {(message: Compared) => void} */
  take({ image, caps, second }) {
    if (image === this.#state.image?.id) this.review.take(image, caps, second);
  }

  /** Selects a cap of the image on screen, which may be one that only the comparison knows. @type {(uid: string) => Promise<void>} */
  async select(uid) {
    const state = this.#state;
    state.select([uid], { reveal: true });
    const [{ image }, { review }] = [state, this];
    if (state.selection.has(uid) || !image || !review.on || !isUidOfPrediction(uid)) return;
    await review.known(image.id);
    if (state.image?.id === image.id && state.selection.uids.size === 0) state.select([uid], { reveal: true });
  }

  /** What the reviewer said of a cap was taken back, or said again. @type {(uid: string, way: "undo" | "redo") => void} */
  saidAgain(uid, way) {
    const { review } = this;
    if (way === "undo") review.decided.delete(uid);
    else review.decided.set(uid, this.#state.items.get(uid));
    review.changed.emit();
    this.#state.select([uid]);
  }

  /** Draws annotations and predictions in turn, or both again. */
  blink() {
    if (this.#timer) return this.#stay();
    this.review.on = true;
    this.#turn();
    this.#timer = setInterval(() => this.#turn(), TURN_MS);
  }

  #turn() {
    this.review.turn = this.review.turn === "annotation" ? "prediction" : "annotation";
    this.#state.signals.overlay.emit();
  }

  #stay() {
    clearInterval(this.#timer);
    this.#timer = 0;
    this.review.turn = null;
    this.#state.signals.overlay.emit();
  }

  /** @type {import("./render/overlay.js").Sketch} */
  sketch = (context, view) => drawReview(context, view, this.#state, this.review);
}
