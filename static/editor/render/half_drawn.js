import { toScreen } from "../geometry/view.js";
import { CASING, COLOURS, FILLS } from "./palette.js";
import { strokeCased, traceRing } from "./paths.js";

/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("../protocol.js").Point} Point */

/**
 * Draws an outline that is half drawn.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {View} view
 * @param {Object} outline
 * @param {readonly Point[]} outline.points  at least one
 * @param {Point | null} outline.next  where the next point would go; null while nobody draws
 * @param {boolean} outline.closing  whether a press would close it
 */
export function drawHalfDrawn(context, view, { points, next, closing }) {
  const line = next ? [...points, closing ? points[0] : next] : points;
  context.beginPath();
  traceRing(context, view, line.flat(), false);
  context.fillStyle = FILLS.selected;
  context.fill();
  if (!next) context.setLineDash([2, 5]);
  strokeCased(context, { colour: COLOURS.draft, width: 2, casing: CASING });
  context.setLineDash([]);
  drawPoints(context, view, points, closing);
}

/** @type {(context: CanvasRenderingContext2D, view: View, points: readonly Point[], closing: boolean) => void} */
function drawPoints(context, view, points, closing) {
  context.beginPath();
  for (const [i, point] of points.entries()) {
    const [x, y] = toScreen(view, ...point);
    const half = i === 0 ? 4 : 2.5;
    context.rect(x - half, y - half, 2 * half, 2 * half);
  }
  context.fillStyle = closing ? COLOURS.whole : COLOURS.draft;
  context.fill();
  context.strokeStyle = "#0b1220";
  context.lineWidth = 1;
  context.stroke();
}
