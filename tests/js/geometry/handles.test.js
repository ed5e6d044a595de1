import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import {
  handlesAreApart,
  movedHandle,
  nearestHandle,
  nudgedHandle,
} from "../../../static/editor/geometry/handles.js";
import { SQUARE, capOf } from "../support/caps.js";

/** @type {import("../../../static/editor/protocol.js").Circle} */
const CIRCLE = { kind: "circle", cx: 50, cy: 50, r: 20 };

test("dragging the rim changes the radius by what the pointer moved outwards", () => {
  const cap = newCap({ mark: CIRCLE });
  const handle = nearestHandle(cap, [50, 71], 5);
  assert.ok(handle);
  assert.deepEqual(handle, { kind: "rim" });
  const moved = movedHandle(cap, handle, { dx: 0, dy: 6, from: [50, 71], pull: 16 });
  assert.deepEqual(moved.mark, { ...CIRCLE, r: 26 });
});

test("a rim dragged onto the centre leaves a circle of one pixel", () => {
  const moved = movedHandle(
    newCap({ mark: CIRCLE }),
    { kind: "rim" },
    { dx: 0, dy: -20, from: [50, 70], pull: 0 },
  );
  assert.deepEqual(moved.mark, { ...CIRCLE, r: 1 });
});

test("dragging the centre moves the mark and not the outline", () => {
  const cap = newCap({ visible: [SQUARE], mark: CIRCLE });
  const handle = nearestHandle(cap, [51, 51], 5);
  assert.ok(handle);
  assert.deepEqual(handle, { kind: "centre" });
  const moved = movedHandle(cap, handle, { dx: 0.25, dy: -1, from: [51, 51], pull: 16 });
  assert.deepEqual(moved, newCap({ visible: [SQUARE], mark: { ...CIRCLE, cx: 50.25, cy: 49 } }));
});

test("right and up make a circle larger, by keys on its rim", () => {
  const cap = newCap({ mark: CIRCLE });
  assert.deepEqual(nudgedHandle(cap, { kind: "rim" }, 0.25, 0).mark, { ...CIRCLE, r: 20.25 });
  assert.deepEqual(nudgedHandle(cap, { kind: "rim" }, 0, -1).mark, { ...CIRCLE, r: 21 });
  assert.deepEqual(nudgedHandle(cap, { kind: "rim" }, 0, 1).mark, { ...CIRCLE, r: 19 });
});

test("handles are apart where the outline has room for them", () => {
  // Three times its width around, 300 px, over four vertices: 75 px each.
  assert.ok(handlesAreApart(capOf(SQUARE), 74));
  assert.ok(!handlesAreApart(capOf(SQUARE), 76));
});
