import assert from "node:assert/strict";
import test from "node:test";

import { polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { seenOf } from "../../../static/editor/geometry/what_is_seen.js";
import { areaOf } from "../../../static/editor/geometry/regions.js";
import { shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { prediction, shapeOf } from "../support/caps.js";

const PHOTO = { width: 1000, height: 800 };
/** @type {(cx: number, cy: number, r: number) => import("../../../static/editor/protocol.js").Circle} */
const circle = (cx, cy, r) => ({ kind: "circle", cx, cy, r });
/** @type {(cx: number, cy: number, r: number) => number[]} */
const disc = (cx, cy, r) => polygonOfCircle(circle(cx, cy, r));
/** What two circles of 50 share whose centres are 50 apart, px². */
const LENS = 2 * 50 ** 2 * Math.acos(0.5) - 25 * Math.sqrt(4 * 50 ** 2 - 50 ** 2);

/** @type {(found: number, meant: number) => void} */
const near = (found, meant) => assert.ok(Math.abs(found - meant) < 0.012 * meant, `${found} for ${meant}`);

test("on free ground all of it is seen; the photo's border cuts it", () => {
  near(areaOf(seenOf(disc(300, 300, 50), [], PHOTO).visible), Math.PI * 50 ** 2);
  near(areaOf(seenOf(disc(0, 300, 50), [], PHOTO).visible), (Math.PI * 50 ** 2) / 2);
});

test("what another cap shows lies in front of it", () => {
  const neighbour = shapeOf("n", polygonOfCircle(circle(350, 300, 50)));
  const { visible, order } = seenOf(disc(300, 300, 50), [neighbour], PHOTO);
  near(areaOf(visible), Math.PI * 50 ** 2 - LENS);
  assert.equal(order, null);
});

test("a bud that lies on a cap is seen whole, and lies in front of that", () => {
  const under = shapeOf("u", polygonOfCircle(circle(300, 300, 80)));
  const { visible, order } = seenOf(disc(310, 300, 12), [under], PHOTO);
  near(areaOf(visible), Math.PI * 12 ** 2);
  assert.equal(order, 1);
});

test("an open prediction of the same cap hides nothing of it, one of another does", () => {
  const same = shapeOfPrediction(prediction(1, [polygonOfCircle(circle(304, 300, 52))]));
  const other = shapeOfPrediction(prediction(2, [polygonOfCircle(circle(350, 300, 50))]));
  near(areaOf(seenOf(disc(300, 300, 50), [same], PHOTO).visible), Math.PI * 50 ** 2);
  near(areaOf(seenOf(disc(300, 300, 50), [other], PHOTO).visible), Math.PI * 50 ** 2 - LENS);
});
