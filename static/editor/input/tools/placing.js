/**
 * Puts down a circle or ellipse that a person has drawn: as the mark of the selected cap where it is that cap's,
 * else as a new cap, of which what nothing hides is seen.
 *
 * @module
 */

import { boundsOfWhole, circleOfWhole, newCap, polygonOfWhole } from "../../geometry/caps.js";
import { seenOf } from "../../geometry/what_is_seen.js";
import { isHalfHidden, isMarkOf, shareInside } from "../../geometry/marks.js";
import { isPrediction, newShape, withCap } from "../../geometry/shapes.js";
import { toScreen } from "../../geometry/view.js";
import { newId } from "../../ids.js";
import { CASING, COLOURS, FILLS } from "../../render/palette.js";
import { strokeCased, traceCross, traceRing, traceWhole, writeCentred } from "../../render/paths.js";
import { changed } from "../../state/changes.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Cap} Cap */
/** @typedef {import("../../protocol.js").Whole} Whole */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */

/** A circle around less of a cap that is not selected is another cap upon it. */
const LEAST_AROUND = 0.5;

/** @type {(state: EditorState, whole: Whole) => void} */
export function place(state, whole) {
  const marked = markedBy(state, whole);
  if (marked) {
    state.commit([changed(marked, withCap(marked, { ...marked.cap, mark: whole }))]);
    state.select([marked.uid]);
    return;
  }
  const after = newShape(newId(), newCapOf(state, whole));
  state.commit([{ before: null, after }]);
  state.select([after.uid]);
  state.signals.drawn.emit(after);
}

/** What would be put down: a new cap, or null where it is a mark. @type {(state: EditorState, whole: Whole) => Shape | null} */
export function newCapBy(state, whole) {
  return markedBy(state, whole) ? null : newShape("", newCapOf(state, whole));
}

/** The selected cap, where this is its mark; while a reviewer looks, any cap that it is around. @type {(state: EditorState, whole: Whole) => Shape | null} */
function markedBy(state, whole) {
  const { sole, explanation } = state;
  const circle = circleOfWhole(whole);
  if (sole && isMarkOf(circle, sole, { halfHidden: isHalfHidden(sole, explanation) })) return sole;
  if (!state.reviewing) return null;
  const caps = state.near(boundsOfWhole(whole)).filter((shape) => !isPrediction(shape) && !shape.cap.ignored);
  return caps.find((shape) => isMarkOf(circle, shape) && isAround(circle, shape.cap)) ?? null;
}

/** @type {(circle: import("../../protocol.js").Circle, cap: Cap) => boolean} */
function isAround(circle, { visible }) {
  return visible.length === 0 || shareInside(visible, circle) >= LEAST_AROUND;
}

/** @type {(state: EditorState, whole: Whole) => Cap} */
function newCapOf(state, whole) {
  const photo = state.image ?? { width: 0, height: 0 };
  const around = state.near(boundsOfWhole(whole)).filter(({ cap }) => !cap.ignored);
  return newCap({ mark: whole, ...seenOf(polygonOfWhole(whole), around, photo) });
}

/** Draws it as it would be put down, and writes which it will be. @type {(context: CanvasRenderingContext2D, state: EditorState, whole: Whole) => void} */
export function drawPlaced(context, state, whole) {
  const { view } = state.viewport;
  const marked = markedBy(state, whole);
  context.beginPath();
  if (marked) traceWhole(context, view, whole);
  else for (const ring of newCapOf(state, whole).visible) traceRing(context, view, ring);
  context.fillStyle = marked ? FILLS.mark : FILLS.outline;
  context.fill();
  context.beginPath();
  traceWhole(context, view, whole);
  traceCross(context, ...toScreen(view, whole.cx, whole.cy), 6);
  strokeCased(context, { colour: COLOURS.mark, width: 2, casing: CASING });
  const [x, y] = toScreen(view, whole.cx, boundsOfWhole(whole).y1);
  const words = marked === state.sole ? "mark of the selected cap" : "mark of this cap";
  writeCentred(context, marked ? words : "new cap", x, y + 6);
}
