import assert from "node:assert/strict";
import test from "node:test";

import { newCap, polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { isCoarse, pointsNeeded } from "../../../static/editor/geometry/points_needed.js";
import { without } from "../../../static/editor/geometry/regions.js";
import { newShape } from "../../../static/editor/geometry/shapes.js";

/** A round outline of so many points. @type {(count: number, r?: number) => number[]} */
function round(count, r = 30) {
  return Array.from({ length: count }, (_, i) => (2 * Math.PI * i) / count).flatMap((a) => [r * Math.cos(a), r * Math.sin(a)]);
}

/** @type {(fields: Parameters<typeof newCap>[0]) => boolean} */
const coarse = (fields) => isCoarse(newShape("u", newCap(fields)), []);

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

/** @type {(uid: string, visible: number[][]) => import("../../../static/editor/geometry/shapes.js").Shape} */
const drawn = (uid, visible) => newShape(uid, newCap({ visible }));

/** @type {(ring: number[], dx: number) => number[]} */
const moved = (ring, dx) => ring.map((value, i) => (i % 2 ? value : value + dx));

test("of an outline that ends at another cap the points of that cap's rim are not counted", () => {
  const front = drawn("front", [moved(round(120), 40)]);
  const behind = drawn("behind", without([round(16)], front.cap.visible));
  assert.ok(behind.cap.visible[0].length / 2 > 40, "it has the rim of the cap in front");
  assert.equal(isCoarse(behind, [front, behind]), true);
  assert.equal(isCoarse(behind, [behind]), false, "nobody is in front any more");
  const enough = drawn("behind", without([round(40)], front.cap.visible));
  assert.equal(isCoarse(enough, [front, enough]), false);
});

test("the cap in front has placed those points itself", () => {
  const front = drawn("front", [moved(round(24), 40)]);
  const behind = drawn("behind", without([round(40)], front.cap.visible));
  assert.equal(isCoarse(front, [front, behind]), false);
  const backwards = drawn("front", [front.cap.visible[0].reduceRight((ring, _, i, all) => (i % 2 ? ring : [...ring, all[i], all[i + 1]]), /** @type {number[]} */ ([]))]);
  assert.equal(isCoarse(backwards, [backwards, behind]), false, "whichever way it was drawn");
});

test("a cap that shares its whole rim with its own copy has placed it", () => {
  const [one, other] = [drawn("a", [round(24)]), drawn("b", [round(24)])];
  assert.equal(isCoarse(one, [one, other]), false);
});
