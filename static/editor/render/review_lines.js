/**
 * Annotations and predictions side by side: the predicted outlines and centres over the drawn ones, and the line
 * from one centre to the other, enlarged on request.
 *
 * @module
 */

import { isPrediction } from "../geometry/shapes.js";
import { toScreen } from "../geometry/view.js";
import { differs, uidOf } from "../state/review.js";
import { CASING, COLOURS } from "./palette.js";
import { strokeCased, traceCap, traceCross, traceRing, traceWhole, writeCentred } from "./paths.js";

/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("../protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../state/review.js").Review} Review */
/** @typedef {CanvasRenderingContext2D} Context */

const ARM_PX = 5;
/** Longer lines between centres have a figure beside them, CSS pixels. */
const TOLD_PX = 3;

/** @type {(context: Context, view: View, state: EditorState, review: Review) => boolean} whether anything was drawn */
export function drawReview(context, view, state, review) {
  if (!review.on || review.image !== state.image?.id) return false;
  for (const cap of review.caps) drawCap(context, view, state, review, cap);
  return review.caps.length > 0;
}

/** @type {(context: Context, view: View, state: EditorState, review: Review, cap: ComparedCap) => void} */
function drawCap(context, view, state, review, cap) {
  const shape = state.shape(uidOf(cap));
  const { prediction } = cap;
  if (shape && !isPrediction(shape) && review.turn !== "prediction") {
    context.beginPath();
    traceCap(context, view, shape.cap);
    strokeCased(context, { colour: COLOURS.outline, width: differs(cap) ? 2 : 1, casing: CASING });
  }
  if (prediction && review.turn !== "annotation") {
    context.beginPath();
    for (const ring of prediction.visible) traceRing(context, view, ring);
    if (prediction.whole) traceWhole(context, view, prediction.whole);
    context.setLineDash([6, 4]);
    strokeCased(context, { colour: COLOURS.predicted, width: differs(cap) ? 2 : 1, casing: CASING });
    context.setLineDash([]);
  }
  if (prediction?.centre && shape?.centre && !isPrediction(shape) && review.turn === null)
    drawError(context, view, shape.centre, prediction.centre, { times: review.times, cdr: cap.cdr, floor: cap.floor });
}

/** @type {(context: Context, view: View, from: import("../protocol.js").Point, to: import("../protocol.js").Point, how: {times: number, cdr: number | null, floor: number | null}) => void} */
function drawError(context, view, from, to, { times, cdr, floor }) {
  const [x0, y0] = toScreen(view, ...from);
  const [x1, y1] = toScreen(view, from[0] + times * (to[0] - from[0]), from[1] + times * (to[1] - from[1]));
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  strokeCased(context, { colour: COLOURS.selected, width: 1.5, casing: CASING });
  for (const [x, y, colour] of /** @type {[number, number, string][]} */ ([
    [x0, y0, COLOURS.outline],
    [x1, y1, COLOURS.predicted],
  ])) {
    context.beginPath();
    traceCross(context, x, y, ARM_PX);
    strokeCased(context, { colour, width: 1.5, casing: CASING });
  }
  if (cdr !== null && Math.hypot(x1 - x0, y1 - y0) > TOLD_PX) writeCentred(context, `${cdr.toFixed(2)} / ${floor?.toFixed(2) ?? "–"} %`, x0, y0 + ARM_PX + 2);
}
