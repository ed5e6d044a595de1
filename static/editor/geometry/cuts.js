/**
 * Cuts caps in two along a stroke, and makes one cap of several.
 *
 * @module
 */

import { areaOfRing, hundredths, insideRing, measure, newCap } from "./caps.js";
import { crossingWith, lengthOf, meeting, stretch, verticesAhead } from "./places.js";
import { areaOf, closedUp, together } from "./regions.js";
import { simplified } from "./strokes.js";
import { FEWEST } from "./vertices.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Mark} Mark */
/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../protocol.js").Point} Point */

/** A piece of less area, px², is a slip of the hand. */
const LEAST_AREA = 4;
/** So near to the rim, as a share of the width of a cap, a stroke may end inside it and is drawn on. */
const NEAR_RIM = 0.25;
/** It is drawn on as its last piece runs, which is so much of it. */
const LAST_PIECE = 0.25;
/** Gaps up to this wide, image pixels, are closed where caps become one. */
export const GAP_PX = 6;

/**
 * The two caps that a stroke across one makes of it, the larger first, and how long the cut is; null where it does not
 * cross one part of the visible outline. An end that lies inside, but near the rim, is drawn on to it. The larger keeps
 * everything else that is known of the cap, but a mark stays with the piece that its centre lies in.
 *
 * @param {Cap} cap
 * @param {Point[]} stroke
 * @param {{reach: number, tolerance: number}} how  image pixels
 * @returns {{caps: [Cap, Cap], length: number} | null}
 */
export function splitCap(cap, stroke, { reach, tolerance }) {
  for (const [i, ring] of cap.visible.entries()) {
    const split = splitRing(ring, stroke, reach, tolerance);
    if (!split) continue;
    const others = cap.visible.filter((_, k) => k !== i);
    const [large, small] = split.pieces.sort((a, b) => areaOfRing(b) - areaOfRing(a));
    const moves = cap.mark !== null && insideRing(small, ...middleOf(cap.mark));
    const larger = { ...cap, visible: [large, ...others], mark: moves ? null : cap.mark };
    const mark = moves ? cap.mark : null;
    const smaller = newCap({ visible: [small], mark, category: cap.category, ...saidOf(cap) });
    return { caps: [larger, smaller], length: split.length };
  }
  return null;
}

/** @type {(ring: number[], stroke: Point[], reach: number, tolerance: number) => {pieces: [number[], number[]], length: number} | null} */
function splitRing(ring, stroke, reach, tolerance) {
  const met = meeting(ring, drawnOn(ring, drawnOn(ring, stroke).toReversed()).toReversed(), reach);
  if (!met) return null;
  const { start, end, between } = met;
  const ahead = verticesAhead(ring, start, end);
  const line = simplified([start.point, ...between, end.point], tolerance);
  const inside = line.slice(1, -1);
  const [one, other] = [
    [...stretch(ring, start, end, ahead), ...inside.toReversed()],
    [...stretch(ring, end, start, ring.length / 2 - ahead), ...inside],
  ].map((points) => points.flatMap(([x, y]) => [hundredths(x), hundredths(y)]));
  const whole = [one, other].every((piece) => piece.length / 2 >= FEWEST && areaOfRing(piece) >= LEAST_AREA);
  return whole ? { pieces: [one, other], length: lengthOf(line) } : null;
}

/**
 * A stroke that ends inside a ring, drawn straight on to the rim where that is near; else as it is.
 *
 * @type {(ring: number[], stroke: Point[]) => Point[]}
 */
function drawnOn(ring, stroke) {
  const [x, y] = stroke[stroke.length - 1];
  const [fx, fy] = stroke[Math.floor((1 - LAST_PIECE) * (stroke.length - 1))];
  const length = Math.hypot(x - fx, y - fy);
  if (length === 0 || !insideRing(ring, x, y)) return stroke;
  const far = (NEAR_RIM * 2 * Math.sqrt(areaOfRing(ring) / Math.PI)) / length;
  const rim = crossingWith(ring, [x, y], [x + far * (x - fx), y + far * (y - fy)]);
  return rim ? [...stroke, rim] : stroke;
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
