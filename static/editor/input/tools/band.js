/**
 * A rectangle drawn over the photo: drawn to the right it takes the caps that it encloses, drawn to the left
 * those that it touches.
 *
 * @module
 */

import { touching, within } from "../../geometry/hit.js";
import { toScreen } from "../../geometry/view.js";

/** @typedef {import("../../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {{from: Point, to: Point}} Band  image pixels */

/** @type {(band: Band) => Bounds} */
function boundsOf({ from: [fx, fy], to: [tx, ty] }) {
  return { x0: Math.min(fx, tx), y0: Math.min(fy, ty), x1: Math.max(fx, tx), y1: Math.max(fy, ty) };
}

/** @type {(band: Band) => boolean} */
function encloses({ from, to }) {
  return to[0] >= from[0];
}

/** The uids of the visible caps that are meant. @type {(state: EditorState, band: Band) => string[]} */
export function inBand(state, band) {
  const bounds = boundsOf(band);
  const near = state.near(bounds);
  return (encloses(band) ? within(near, bounds) : touching(near, bounds)).map(({ uid }) => uid);
}

/** Dashed where to touch is enough. @type {(context: CanvasRenderingContext2D, view: import("../../geometry/view.js").View, band: Band) => void} */
export function drawBand(context, view, band) {
  const bounds = boundsOf(band);
  const [left, top] = toScreen(view, bounds.x0, bounds.y0);
  const [right, bottom] = toScreen(view, bounds.x1, bounds.y1);
  context.setLineDash(encloses(band) ? [] : [4, 3]);
  context.strokeStyle = "#ffffff";
  context.lineWidth = 1;
  context.fillStyle = "rgba(255, 255, 255, 0.12)";
  context.fillRect(left, top, right - left, bottom - top);
  context.strokeRect(left, top, right - left, bottom - top);
  context.setLineDash([]);
}
