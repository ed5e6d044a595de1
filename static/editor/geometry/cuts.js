/**
 * Cuts caps in two along a stroke, and makes one cap of several.
 *
 * @module
 */

import { areaOfRing, hundredths, insideRing, measure, newCap } from "./caps.js";
import { meeting, stretch, verticesAhead } from "./places.js";
import { areaOf, closedUp, together } from "./regions.js";
import { simplified } from "./strokes.js";
import { FEWEST } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Mark} Mark */
/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../protocol.js").Point} Point */

/** A piece of less area, px², is a slip of the hand. */
const LEAST_AREA = 4;
/** Gaps up to this wide, image pixels, are closed where caps become one. */
export const GAP_PX = 6;

/**
 * The two caps that a stroke across one makes of it, the larger first; null where it does not cross one part of
 * the visible outline. The larger keeps everything else that is known of the cap, but a mark stays with the piece that its
 * centre lies in.
 *
 * @param {Cap} cap
 * @param {Point[]} stroke
 * @param {{reach: number, tolerance: number}} how  image pixels
 * @returns {[Cap, Cap] | null}
 */
export function splitCap(cap, stroke, { reach, tolerance }) {
  for (const [i, ring] of cap.visible.entries()) {
    const pieces = splitRing(ring, stroke, reach, tolerance);
    if (!pieces) continue;
    const others = cap.visible.filter((_, k) => k !== i);
    const [large, small] = pieces.sort((a, b) => areaOfRing(b) - areaOfRing(a));
    const moves = cap.mark !== null && insideRing(small, ...middleOf(cap.mark));
    return [
      { ...cap, visible: [large, ...others], mark: moves ? null : cap.mark },
      newCap({ visible: [small], mark: moves ? cap.mark : null, category: cap.category, ...saidOf(cap) }),
    ];
  }
  return null;
}

/** @type {(ring: number[], stroke: Point[], reach: number, tolerance: number) => [number[], number[]] | null} */
function splitRing(ring, stroke, reach, tolerance) {
  const met = meeting(ring, stroke, reach);
  if (!met) return null;
  const { start, end, between } = met;
  const ahead = verticesAhead(ring, start, end);
  const line = simplified([start.point, ...between, end.point], tolerance);
  const inside = line.slice(1, -1);
  const pieces = [
    [...stretch(ring, start, end, ahead), ...inside.toReversed()],
    [...stretch(ring, end, start, ring.length / 2 - ahead), ...inside],
  ].map((points) => points.flatMap(([x, y]) => [hundredths(x), hundredths(y)]));
  const whole = pieces.every((piece) => piece.length / 2 >= FEWEST && areaOfRing(piece) >= LEAST_AREA);
  return whole ? [pieces[0], pieces[1]] : null;
}

/** What was said of pieces of a rim stays with them; the server drops it where they are not. @type {(cap: Cap) => Partial<Cap>} */
function saidOf({ arcs }) {
  return arcs ? { arcs } : {};
}

/** @type {(mark: Mark) => Point} */
function middleOf(mark) {
  if (mark.kind !== "polygon") return [mark.cx, mark.cy];
  const { bounds } = measure(newCap({ mark }));
  return bounds ? [(bounds.x0 + bounds.x1) / 2, (bounds.y0 + bounds.y1) / 2] : [NaN, NaN];
}

/**
 * The visible outline of several caps as one, gaps of a few pixels between them closed. Where they lie farther
 * apart it has several parts.
 *
 * @param {Cap[]} caps
 * @returns {Outline}
 */
export function mergedOutline(caps) {
  const visible = caps.reduce((all, cap) => together(all, cap.visible), /** @type {Outline} */ ([]));
  return closedUp(visible, GAP_PX).sort((a, b) => areaOf([b]) - areaOf([a]));
}
