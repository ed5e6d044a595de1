import assert from "node:assert/strict";
import test from "node:test";

import { covers, extentOf, goneOn, isOverstretched, isSharp, placeOf } from "../../../static/editor/render/extents.js";

const SIZE = { width: 1000, height: 800 };
const PHOTO = { x0: 0, y0: 0, x1: 4000, y1: 3000 };

/** @type {(view: import("../../../static/editor/geometry/view.js").View, more?: object) => import("../../../static/editor/render/extents.js").Wanted} */
function wanted(view, more = {}) {
  return { view, size: SIZE, ratio: 1, content: PHOTO, beyond: 0, ...more };
}

test("a picture reaches beyond the window on every side, and no further than the photo", () => {
  const inside = extentOf(wanted({ scale: 1, x: -1000, y: -1000 }), "moving");
  assert.deepEqual(inside, { view: { scale: 1, x: -808, y: -808 }, width: 1384, height: 1184, ratio: 1 });
  const corner = extentOf(wanted({ scale: 1, x: 20, y: -30 }), "moving");
  assert.deepEqual(corner, { view: { scale: 1, x: 0, y: 0 }, width: 1172, height: 1022, ratio: 1 });
  const whole = extentOf(wanted({ scale: 0.2, x: 100, y: 100 }, { beyond: 64 }), "moving");
  assert.deepEqual(whole, { view: { scale: 0.2, x: 64, y: 64 }, width: 928, height: 728, ratio: 1 });
});

test("a picture lies where the view has its corner, moved and stretched", () => {
  const extent = extentOf(wanted({ scale: 1, x: -1000, y: -1000 }), "moving");
  assert.deepEqual(placeOf(extent, { scale: 1, x: -900, y: -1000 }), { x: -92, y: -192, stretch: 1 });
  // Image pixel (808, 808) is the corner.
  assert.deepEqual(placeOf(extent, { scale: 2, x: 0, y: 10 }), { x: 1616, y: 1626, stretch: 2 });
});

test("a picture covers the window until it is moved by more than its margin", () => {
  const extent = extentOf(wanted({ scale: 1, x: -1000, y: -1000 }), "moving");
  assert.ok(covers(extent, wanted({ scale: 1, x: -808, y: -1192 })));
  assert.ok(!covers(extent, wanted({ scale: 1, x: -807, y: -1000 })));
  assert.ok(!covers(extent, wanted({ scale: 1, x: -1000, y: -1193 })));
});

test("where the photo ends, nothing is left bare", () => {
  const extent = extentOf(wanted({ scale: 0.2, x: 100, y: 100 }), "moving");
  for (const x of [-700, 0, 900]) assert.ok(covers(extent, wanted({ scale: 0.2, x, y: 100 })));
  assert.ok(covers(extent, wanted({ scale: 0.1, x: 0, y: 0 })));
});

test("only a picture of this very scale is sharp, and none made for stretching", () => {
  const view = { scale: 1, x: -1000, y: -1000 };
  assert.ok(isSharp(extentOf(wanted(view), "moving"), wanted({ ...view, x: -900 })));
  assert.ok(!isSharp(extentOf(wanted(view), "moving"), wanted({ ...view, scale: 1.01 })));
  assert.ok(!isSharp(extentOf(wanted(view), "enlarging"), wanted(view)));
  assert.ok(!isSharp(extentOf(wanted(view), "shrinking"), wanted(view)));
});

test("a picture made while shrinking covers a window twice as wide, with no more pixels than the window has", () => {
  const view = { scale: 1, x: -1500, y: -1100 };
  const extent = extentOf(wanted(view), "shrinking");
  assert.equal(extent.width * extent.ratio * extent.height * extent.ratio, SIZE.width * SIZE.height);
  // About the middle of the window.
  const half = { scale: 0.5, x: -1500 / 2 + 250, y: -1100 / 2 + 200 };
  assert.ok(covers(extent, wanted(half)));
  assert.ok(!covers(extent, wanted({ ...half, scale: 0.45 })));
});

test("lines twice as thick or half as thick are as far as a picture is stretched", () => {
  const extent = extentOf(wanted({ scale: 1, x: -1000, y: -1000 }), "moving");
  for (const scale of [0.5, 1, 2]) assert.ok(!isOverstretched(extent, { scale, x: 0, y: 0 }));
  for (const scale of [0.49, 2.01]) assert.ok(isOverstretched(extent, { scale, x: 0, y: 0 }));
});

test("a movement is looked ahead by two more steps like the last", () => {
  const before = { scale: 1, x: 0, y: 10 };
  assert.deepEqual(goneOn(before, { scale: 1, x: 30, y: 5 }), { scale: 1, x: 90, y: -5 });
  // Twice as large about (100, 50), which stays where it is: 100 = 8 · 100 - 700.
  assert.deepEqual(goneOn({ scale: 1, x: 0, y: 0 }, { scale: 2, x: -100, y: -50 }), { scale: 8, x: -700, y: -350 });
  assert.deepEqual(goneOn(before, before), before);
});
