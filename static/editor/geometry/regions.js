/**
 * Areas put together and taken from each other. An area is an outline: parts, each a ring without holes, image
 * pixels throughout; what comes out is on hundredths of a pixel.
 *
 * @module
 */

import { ClipType, FillRule } from "../../vendor/clipper2/Core.js";
import { Clipper64 } from "../../vendor/clipper2/Engine.js";
import { ClipperOffset, EndType, JoinType } from "../../vendor/clipper2/Offset.js";
import { areaOfRing } from "./caps.js";

/** @typedef {import("../protocol.js").Outline} Outline */
/** @typedef {import("../../vendor/clipper2/Core.js").Paths64} Paths */

/** Clipper reckons in whole numbers: hundredths of a pixel. */
const STEPS = 100;
/** A part of less area, px², is none: where borders nearly meet, such splinters are left. */
const LEAST_AREA = 1;
/** How far the round of an outline that was grown may stray from a circle, hundredths of a pixel. */
const ROUND = 5;

/** What lies in either. @type {(a: Outline, b: Outline) => Outline} */
export function together(a, b) {
  return clipped(ClipType.Union, a, b);
}

/** What of an area lies outside of another. @type {(area: Outline, other: Outline) => Outline} */
export function without(area, other) {
  return clipped(ClipType.Difference, area, other);
}

/** What lies in both. @type {(a: Outline, b: Outline) => Outline} */
export function shared(a, b) {
  return clipped(ClipType.Intersection, a, b);
}

/** @type {(outline: Outline) => number} */
export function areaOf(outline) {
  return outline.reduce((sum, ring) => sum + areaOfRing(ring), 0);
}

/**
 * The area with gaps and notches of up to `gap` pixels filled in.
 *
 * @type {(area: Outline, gap: number) => Outline}
 */
export function closedUp(area, gap) {
  const grown = moved(pathsOf(area), (gap / 2) * STEPS);
  const closed = outlineOf(moved(grown, (-gap / 2) * STEPS));
  // Only what fills a gap is added: growing and shrinking alone would wear off every vertex a little.
  return together(area, without(closed, area));
}

/** The area without what of it is thinner than `width` pixels: fingers, splinters. @type {(area: Outline, width: number) => Outline} */
export function withoutFingers(area, width) {
  const shrunk = moved(pathsOf(area), (-width / 2) * STEPS);
  const thin = without(area, outlineOf(moved(shrunk, (width / 2) * STEPS)));
  // What shrinking and growing alone wears off a right-angled corner is no finger.
  const worn = 2 * (1 - Math.PI / 4) * (width / 2) ** 2;
  return without(area, thin.filter((ring) => areaOfRing(ring) > worn));
}

/** @type {(type: ClipType, area: Outline, other: Outline) => Outline} */
function clipped(type, area, other) {
  const clipper = new Clipper64();
  clipper.addSubject(pathsOf(area));
  clipper.addClip(pathsOf(other));
  /** @type {Paths} */
  const solution = [];
  clipper.execute(type, FillRule.NonZero, solution);
  return outlineOf(solution);
}

/** The rim moved outwards, or inwards where `by` is below zero. @type {(paths: Paths, by: number) => Paths} */
function moved(paths, by) {
  const offset = new ClipperOffset(2, ROUND);
  offset.addPaths(paths, JoinType.Round, EndType.Polygon);
  /** @type {Paths} */
  const solution = [];
  offset.execute(by, solution);
  return solution;
}

/** Turned alike, whichever way they are drawn. @type {(outline: Outline) => Paths} */
function pathsOf(outline) {
  return outline.map((ring) => {
    const path = Array.from({ length: ring.length / 2 }, (_, i) => ({
      x: Math.round(ring[2 * i] * STEPS),
      y: Math.round(ring[2 * i + 1] * STEPS),
    }));
    return turned(ring) < 0 ? path.reverse() : path;
  });
}

/** Holes are filled: an outline has none. @type {(paths: Paths) => Outline} */
function outlineOf(paths) {
  return paths
    .map((path) => path.flatMap(({ x, y }) => [x / STEPS, y / STEPS]))
    .filter((ring) => turned(ring) >= LEAST_AREA);
}

/** The area, below zero where the ring runs the other way. @type {(ring: number[]) => number} */
export function turned(ring) {
  let twice = 0;
  for (let i = 0, j = ring.length - 2; i < ring.length; j = i, i += 2) {
    twice += ring[j] * ring[i + 1] - ring[i] * ring[j + 1];
  }
  return twice / 2;
}
