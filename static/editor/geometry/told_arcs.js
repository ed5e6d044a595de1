/**
 * What people say of pieces of a visible outline: which kind each is, by a line along it. What is said last
 * holds.
 *
 * @module
 */

import { distanceToEdge } from "./strokes.js";

/** @typedef {import("../protocol.js").Arc} Arc */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").ToldArc} ToldArc */

/** The kinds that people name, in the order in which clicks go through them. @type {ToldArc["kind"][]} */
export const TOLD_KINDS = ["visible", "hidden", "border", "contact"];
/** A line is on another that it leaves by no more than this, image pixels, and half a step of the other. */
const ON_LINE = 1.5;

/** The kind that a click makes of one; a hollow is most likely hidden. @type {(kind: Arc["kind"]) => ToldArc["kind"]} */
export function nextKind(kind) {
  if (kind === "concave") return "hidden";
  return TOLD_KINDS[(TOLD_KINDS.findIndex((told) => told === kind) + 1) % TOLD_KINDS.length];
}

/** The arc that passes nearest to a point, within `reach`. @type {(arcs: Arc[], point: Point, reach: number) => Arc | null} */
export function nearestArc(arcs, point, reach) {
  let [best, found] = [reach, /** @type {Arc | null} */ (null)];
  for (const arc of arcs) {
    const distance = distanceToLine(point, arc.points);
    if (distance > best) continue;
    [best, found] = [distance, arc];
  }
  return found;
}

/** The cap with a piece of its outline called so; what was said of that piece alone is forgotten. @type {(cap: Cap, kind: ToldArc["kind"], points: number[]) => Cap} */
export function called(cap, kind, points) {
  const { arcs = [] } = uncalled(cap, points);
  return { ...cap, arcs: [...arcs, { kind, points }] };
}

/** The cap without what was said of pieces that lie wholly on this one. @type {(cap: Cap, points: number[]) => Cap} */
export function uncalled(cap, points) {
  const left = (cap.arcs ?? []).filter((told) => !liesOn(told.points, points));
  const { arcs: _, ...rest } = cap;
  return left.length ? { ...rest, arcs: left } : rest;
}

/** @type {(arcs: ToldArc[], dx: number, dy: number) => ToldArc[]} */
export function movedArcs(arcs, dx, dy) {
  return arcs.map(({ kind, points }) => ({ kind, points: points.map((value, i) => value + (i % 2 ? dy : dx)) }));
}

/** The point in the middle of an arc. @type {(arc: {points: number[]}) => Point} */
export function middleOf({ points }) {
  const at = 2 * (points.length >> 2);
  return [points[at], points[at + 1]];
}

/** @type {(points: number[], line: number[]) => boolean} */
function liesOn(points, line) {
  const reach = ON_LINE + longestStep(line) / 2;
  for (let i = 0; i < points.length; i += 2)
    if (distanceToLine([points[i], points[i + 1]], line) > reach) return false;
  return true;
}

/** @type {(line: number[]) => number} */
function longestStep(line) {
  let longest = 0;
  for (let i = 2; i < line.length; i += 2)
    longest = Math.max(longest, Math.hypot(line[i] - line[i - 2], line[i + 1] - line[i - 1]));
  return longest;
}

/** @type {(point: Point, line: number[]) => number} */
function distanceToLine(point, line) {
  if (line.length === 2) return Math.hypot(line[0] - point[0], line[1] - point[1]);
  let best = Infinity;
  for (let i = 0; i + 3 < line.length; i += 2)
    best = Math.min(best, distanceToEdge(point, [line[i], line[i + 1]], [line[i + 2], line[i + 3]]));
  return best;
}
