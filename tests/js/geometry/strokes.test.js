import assert from "node:assert/strict";
import test from "node:test";

import { comesRound, edgesCross } from "../../../static/editor/geometry/strokes.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/**
 * An arc of a circle of 60 around the origin, a point every 6 degrees.
 *
 * @type {(from: number, to: number, radius?: (degrees: number) => number) => Point[]}
 */
function arc(from, to, radius = () => 60) {
  return Array.from({ length: Math.floor((to - from) / 6) + 1 }, (_, i) => from + 6 * i).map((degrees) => {
    const angle = (degrees * Math.PI) / 180;
    return [radius(degrees) * Math.cos(angle), radius(degrees) * Math.sin(angle)];
  });
}

test("a stroke that stops well before its start does not come round", () => {
  assert.equal(comesRound(arc(0, 300), 3), false);
});

test("a stroke that runs on beyond its start comes round: on its own track, outside it and across it", () => {
  const outside = arc(0, 400, (degrees) => 60 + degrees / 180);
  const across = arc(0, 400, (degrees) => 60 + (degrees > 300 ? (372 - degrees) / 3 : 0));
  assert.ok(comesRound(arc(0, 400), 3));
  assert.ok(comesRound(outside, 3));
  assert.ok(comesRound(across, 0.5));
});

test("a spiral that keeps away from its start does not come round", () => {
  const spiral = arc(0, 400, (degrees) => 60 + degrees / 18);
  assert.equal(comesRound(spiral, 3), false);
});

test("a small loop where the hand slipped does not come round", () => {
  /** @type {Point[]} */
  const slip = [
    [0, 0],
    [10, 0],
    [20, 0],
    [24, 4],
    [20, 8],
    [16, -4],
    [30, -6],
    [40, -6],
    [50, -6],
    [60, -6],
    [70, -6],
  ];
  assert.ok(edgesCross(slip[1], slip[2], slip[4], slip[5]));
  assert.equal(comesRound(slip, 3), false);
});

test("edges that only touch do not cross", () => {
  assert.equal(edgesCross([0, 0], [10, 0], [5, 0], [5, 5]), false);
  assert.equal(edgesCross([0, 0], [10, 0], [10, 0], [20, 5]), false);
  assert.ok(edgesCross([0, 0], [10, 0], [5, -1], [5, 5]));
});

test("a point, two points and none do not come round", () => {
  for (const count of [0, 1, 2, 3]) assert.equal(comesRound(arc(0, 600).slice(0, count), 1), false);
});
