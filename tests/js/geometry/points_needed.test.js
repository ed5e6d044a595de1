import assert from "node:assert/strict";
import test from "node:test";

import { newCap, polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { isCoarse, pointsNeeded } from "../../../static/editor/geometry/points_needed.js";
import { newShape } from "../../../static/editor/geometry/shapes.js";

/** A round outline of so many points. @type {(count: number, r?: number) => number[]} */
function round(count, r = 30) {
  return Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count).flatMap((a) => [r * Math.cos(a), r * Math.sin(a)]);
}

/** @type {(fields: Parameters<typeof newCap>[0]) => boolean} */
const coarse = (fields) => isCoarse(newShape("u", newCap(fields)));

test("small, medium and large caps need 10, 20 and 25 points", () => {
  assert.deepEqual([1000, 1024, 9000, 9216].map(pointsNeeded), [10, 20, 20, 25]);
});

test("an outline drawn by hand has too few points or enough", () => {
  assert.deepEqual([coarse({ visible: [round(19)] }), coarse({ visible: [round(21)] })], [true, false]);
});

test("what was generated is not counted: predictions, and what a circle shows", () => {
  assert.equal(coarse({ visible: [round(8)], prediction: 4 }), false);
  assert.equal(coarse({ visible: [round(8)], mark: { kind: "circle", cx: 0, cy: 0, r: 30 } }), false);
  assert.equal(coarse({ visible: [], mark: { kind: "polygon", points: polygonOfCircle({ kind: "circle", cx: 0, cy: 0, r: 9 }) } }), false);
});
