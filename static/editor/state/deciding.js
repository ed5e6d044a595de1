/**
 * What becomes of a cap when a reviewer decides on it.
 *
 * @module
 */

import { isPrediction, withCap } from "../geometry/shapes.js";
import { changed, heirsIn } from "./changes.js";
import { uidOf } from "./review.js";

/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("./editor_state.js").EditorState} EditorState */
/** @typedef {import("./review.js").Review} Review */

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
  review.changed.emit();
}

/**
 * Has a cap be as the network said: its outline without a mark, the prediction itself, or no cap. A cap that was moved
 * so far that nothing matches it goes back to the prediction that it started from. Of a second annotator the mark is
 * taken with the outline.
 *
 * @type {(state: EditorState, review: Review, cap: ComparedCap) => void}
 */
export function takePrediction(state, review, cap) {
  const partner = partnerOf(state, review, cap);
  const uid = cap.annotation ?? partner?.annotation ?? uidOf(cap);
  const said = cap.prediction ?? partner?.prediction;
  const shape = state.items.get(uid);
  if (!shape) return;
  const mark = review.second && said?.extra.marked ? said.whole : null;
  if (isPrediction(shape)) state.commit([changed(shape, mark ? withCap(shape, { ...shape.cap, mark }) : shape)]);
  else if (!said) state.commit([changed(shape, { ...shape, deleted: true })]);
  else state.commit([changed(shape, withCap(shape, { ...shape.cap, visible: said.visible, mark }))]);
}

/** The prediction that a missed cap started from, where that is extra; and the other way round. @type {(state: EditorState, review: Review, cap: ComparedCap) => ComparedCap | null} */
export function partnerOf({ store }, { caps }, { annotation, prediction }) {
  if (annotation && prediction) return null;
  const heir = annotation ? store.get(annotation) : heirsIn(store).get(prediction?.id ?? 0);
  const isIt = (/** @type {ComparedCap} */ other) =>
    annotation ? !other.annotation && other.prediction?.id === heir?.cap.prediction : other.annotation === heir?.uid && !other.prediction;
  return heir ? (caps.find(isIt) ?? null) : null;
}
