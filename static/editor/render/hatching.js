import { placedWhole } from "../geometry/caps.js";
import { FILLS } from "./palette.js";
import { traceRing, traceWhole } from "./paths.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("./paths.js").Context} Context */

/**
 * Hatches what is known of ignored caps: the visible outline, else the mark.
 *
 * @type {(context: Context, view: View, shapes: Shape[]) => void}
 */
export function hatch(context, view, shapes) {
  const pattern = shapes.length ? linesFor(context) : null;
  if (!pattern) return;
  context.fillStyle = pattern;
  for (const { cap } of shapes) {
    traceKnown(context, view, cap);
    context.fill();
  }
}

/** The visible outline of a cap, else its mark, as a path. @type {(context: Context, view: View, cap: Cap) => void} */
export function traceKnown(context, view, cap) {
  context.beginPath();
  const polygon = cap.mark?.kind === "polygon" ? [cap.mark.points] : [];
  for (const ring of cap.visible.length ? cap.visible : polygon) traceRing(context, view, ring);
  const placed = cap.visible.length ? null : placedWhole(cap);
  if (placed) traceWhole(context, view, placed);
}

/** @type {(context: Context) => CanvasPattern | null} */
function linesFor(context) {
  const tile = new OffscreenCanvas(6, 6);
  const lines = tile.getContext("2d");
  if (!lines) return null;
  lines.strokeStyle = FILLS.ignored;
  lines.lineWidth = 1.5;
  for (const offset of [-6, 0, 6]) {
    lines.moveTo(offset - 1, 7);
    lines.lineTo(offset + 7, -1);
  }
  lines.stroke();
  return context.createPattern(tile, "repeat");
}
