import assert from "node:assert/strict";
import test from "node:test";

import { areaOf, closedUp, shared, together, without, withoutFingers } from "../../../static/editor/geometry/regions.js";

/** @type {(x: number, y: number, size: number) => number[]} */
const square = (x, y, size) => [x, y, x + size, y, x + size, y + size, x, y + size];
const LEFT = [square(0, 0, 10)];
const RIGHT = [square(5, 0, 10)];
const AWAY = [square(13, 0, 10)];

test("areas are put together, taken from each other, and shared as rectangles are by hand", () => {
  assert.deepEqual(
    [together(LEFT, RIGHT), without(LEFT, RIGHT), shared(LEFT, RIGHT), shared(LEFT, AWAY)].map(areaOf),
    [150, 50, 50, 0],
  );
  assert.deepEqual([together(LEFT, AWAY).length, together(LEFT, RIGHT).length], [2, 1]);
});

test("which way a ring runs makes no difference", () => {
  const backwards = [[0, 10, 10, 10, 10, 0, 0, 0]];
  assert.equal(areaOf(together(backwards, RIGHT)), 150);
  assert.equal(areaOf(without(RIGHT, backwards)), 50);
});

test("areas with a border in common are one, and neither takes anything from the other", () => {
  const beside = [square(10, 0, 10)];
  assert.deepEqual([together(LEFT, beside).length, areaOf(without(LEFT, beside))], [1, 100]);
});

test("a gap is closed up to its width and no farther, and corners stay what they are", () => {
  assert.deepEqual([closedUp([...LEFT, ...AWAY], 2).length, closedUp([...LEFT, ...AWAY], 6).length], [2, 1]);
  const bridged = areaOf(closedUp([...LEFT, ...AWAY], 6));
  assert.ok(bridged > 200 + 0.9 * 30 && bridged <= 200 + 30, String(bridged));
  assert.deepEqual(areaOf(closedUp([square(0, 0, 100)], 6)), 10000);
});

test("a hole is filled, as an outline has none, and splinters are left out", () => {
  assert.equal(areaOf(without([square(0, 0, 30)], [square(10, 10, 10)])), 900);
  assert.deepEqual(without(LEFT, [square(0.05, -1, 12)]), []);
});

test("a finger is cut off, and corners stay what they are", () => {
  const body = [0, 0, 100, 0, 100, 40, 140, 40, 140, 43, 100, 43, 100, 100, 0, 100];
  assert.ok(Math.abs(areaOf(withoutFingers([body], 6)) - 10000) < 4);
  assert.equal(areaOf(withoutFingers([body], 2)), 10120);
});
