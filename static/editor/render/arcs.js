/**
 * How the whole outline of the selected cap came about, drawn over it: the arcs of the visible outline, and
 * how well the centre is known.
 *
 * @module
 */

import { boundsOfPoints, joinedAll } from "../geometry/bounds.js";
import { toScreen } from "../geometry/view.js";
import { ARCS, CASING, COLOURS } from "./palette.js";
import { strokeCased, traceRing } from "./paths.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("../protocol.js").Fitted} Fitted */
/** @typedef {CanvasRenderingContext2D} Context */

const ARC_PX = 4;
/** A centre known better than this is drawn so: a smaller ellipse could not be seen. */
const LEAST_PX = 2.5;

/** @type {(context: Context, view: View, fitted: Fitted) => void} */
export function drawArcs(context, view, { arcs }) {
  for (const { kind, points } of arcs) {
    const { colour, dash } = ARCS[kind];
    context.beginPath();
    // A canvas draws nothing of a line without length.
    const [x, y] = points;
    traceRing(context, view, points.length > 2 ? points : [x, y, x + 0.01, y], false);
    context.setLineDash([]);
    context.strokeStyle = CASING;
    context.lineWidth = ARC_PX + 2;
    context.stroke();
    context.setLineDash(dash);
    context.strokeStyle = colour;
    context.lineWidth = ARC_PX;
    context.stroke();
  }
  context.setLineDash([]);
}

/**
 * The ellipse of one standard deviation around the centre.
 *
 * @type {(context: Context, view: View, fitted: Fitted) => void}
 */
export function drawUncertainty(context, view, { fit: { centre, centre_sd } }) {
  if (!centre || !centre_sd) return;
  const [rx, ry] = centre_sd.map((sd) => Math.max(sd * view.scale, LEAST_PX));
  context.beginPath();
  context.ellipse(...toScreen(view, ...centre), rx, ry, 0, 0, 2 * Math.PI);
  strokeCased(context, { colour: COLOURS.whole, width: 1.5, casing: CASING });
}

/** What all that covers, image pixels. @type {(fitted: Fitted) => Bounds | null} */
export function reachOfFit({ arcs, fit: { centre, centre_sd } }) {
  const boxes = arcs.map(({ points }) => boundsOfPoints(points));
  if (centre && centre_sd) {
    const [[x, y], [sx, sy]] = [centre, centre_sd];
    boxes.push({ x0: x - sx, y0: y - sy, x1: x + sx, y1: y + sy });
  }
  return joinedAll(boxes);
}
