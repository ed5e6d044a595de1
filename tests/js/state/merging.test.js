import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import { areaOf } from "../../../static/editor/geometry/regions.js";
import { newShape, shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { merged } from "../../../static/editor/state/merging.js";
import { prediction } from "../support/caps.js";

/** @type {(x: number, width: number) => number[]} */
const box = (x, width) => [x, 0, x + width, 0, x + width, 50, x, 50];
const MARK = /** @type {const} */ ({ kind: "circle", cx: 10, cy: 10, r: 5 });

test("the largest is kept with what is known of it, the others are deleted, and a mark is not lost", () => {
  const small = newShape("small", newCap({ visible: [box(0, 30)], mark: MARK }));
  const large = newShape("large", newCap({ visible: [box(33, 60)], order: 3 }));
  const [kept, gone] = merged([small, large]);
  assert.deepEqual([kept.after.uid, kept.after.cap.order, kept.after.cap.mark], ["large", 3, MARK]);
  assert.ok(areaOf(kept.after.cap.visible) > 30 * 50 + 60 * 50);
  assert.equal(kept.after.cap.visible.length, 1);
  assert.deepEqual([gone.after.uid, gone.after.deleted], ["small", true]);
});

test("what people agreed on is kept before a larger prediction, which is turned down", () => {
  const cap = newShape("cap", newCap({ visible: [box(0, 30)] }));
  const [kept, gone] = merged([shapeOfPrediction(prediction(4, [box(30, 90)])), cap]);
  assert.deepEqual([kept.after.uid, gone.after.deleted, gone.after.cap.prediction], ["cap", true, 4]);
});
