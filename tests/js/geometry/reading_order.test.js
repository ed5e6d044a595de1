import assert from "node:assert/strict";
import test from "node:test";

import { inReadingOrder } from "../../../static/editor/geometry/reading_order.js";
import { shapeOf } from "../support/caps.js";

/** @type {(uid: string, x: number, y: number, size?: number) => import("../../../static/editor/geometry/shapes.js").Shape} */
const at = (uid, x, y, size = 100) =>
  shapeOf(uid, [x - size / 2, y - size / 2, x + size / 2, y - size / 2, x + size / 2, y + size / 2, x - size / 2, y + size / 2]);

test("rows are read from above, each from left to right, though no two caps lie quite level", () => {
  const shapes = [at("e", 300, 220), at("b", 200, 80), at("a", 90, 110), at("d", 110, 205), at("c", 310, 95)];
  assert.deepEqual(inReadingOrder(shapes).map(({ uid }) => uid), ["a", "b", "c", "d", "e"]);
});

test("how high a row is depends on how large the caps are", () => {
  const shapes = [at("low", 10, 40, 20), at("high", 90, 10, 20)];
  assert.deepEqual(inReadingOrder(shapes).map(({ uid }) => uid), ["high", "low"]);
  const large = [at("left", 10, 40, 200), at("right", 90, 10, 200)];
  assert.deepEqual(inReadingOrder(large).map(({ uid }) => uid), ["left", "right"]);
});
