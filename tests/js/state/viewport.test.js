import assert from "node:assert/strict";
import test from "node:test";

import { toImage } from "../../../static/editor/geometry/view.js";
import { Viewport } from "../../../static/editor/state/viewport.js";
import { IMAGE } from "../support/state.js";

/** 2000 × 1500 pixels in a window of 1024 × 774: half of its size, 12 pixels from the edges. */
function opened() {
  const viewport = new Viewport(() => {});
  viewport.resize({ width: 1024, height: 774 });
  viewport.open(IMAGE);
  return viewport;
}

/** @type {(viewport: Viewport) => number[]} */
const middle = ({ view, size }) => toImage(view, size.width / 2, size.height / 2).map(Math.round);

test("a photo is opened as a whole", () => {
  const { view } = opened();
  assert.deepEqual(view, { scale: 0.5, x: 12, y: 12 });
});

test("a whole photo stays whole in a window of another size", () => {
  const viewport = opened();
  viewport.resize({ width: 2024, height: 1524 });
  assert.deepEqual(viewport.view, { scale: 1, x: 12, y: 12 });
  viewport.resize({ width: 524, height: 1524 });
  assert.deepEqual([viewport.view.scale, viewport.view.x], [0.25, 12]);
});

test("what was in the middle stays there, as large as it was, in a window of another size", () => {
  const viewport = opened();
  viewport.zoomAt(700, 300, 8);
  const [before, { scale }] = [middle(viewport), viewport.view];
  viewport.resize({ width: 600, height: 900 });
  assert.deepEqual([middle(viewport), viewport.view.scale], [before, scale]);
});

test("a photo that was made small by hand, but was all there, is all there in a small window too", () => {
  const viewport = opened();
  viewport.zoomAt(500, 400, 0.6);
  viewport.resize({ width: 1400, height: 1000 });
  assert.equal(viewport.view.scale, 0.3);
  viewport.resize({ width: 424, height: 1000 });
  assert.deepEqual([viewport.view.scale, viewport.view.x], [0.2, 12]);
});

test("an image that was left as a whole is found as a whole in a window that changed meanwhile", () => {
  const viewport = opened();
  viewport.open({ ...IMAGE, id: 2 });
  viewport.resize({ width: 524, height: 399 });
  viewport.open(IMAGE);
  assert.deepEqual(viewport.view, { scale: 0.25, x: 12, y: 12 });
});

test("a part that was looked at before a reload is looked at again, also in another window", () => {
  const before = opened();
  before.zoomAt(700, 300, 8);
  const after = new Viewport(() => {});
  after.expect(IMAGE.id, before.look);
  after.open(IMAGE);
  after.resize({ width: 800, height: 600 });
  assert.deepEqual([middle(after), after.view.scale], [middle(before), before.view.scale]);
});

test("showing what is on screen already moves nothing, and a whole photo stays whole", () => {
  const viewport = opened();
  const before = viewport.view;
  viewport.reveal({ x0: 100, y0: 100, x1: 180, y1: 180 }, { close: false });
  assert.deepEqual([viewport.view, viewport.look], [before, null]);
});

test("a part is on screen as soon as anything of it is", () => {
  const viewport = opened();
  viewport.zoomAt(12, 12, 2);
  assert.ok(viewport.shows({ x0: 1000, y0: 0, x1: 1100, y1: 10 }));
  assert.equal(viewport.shows({ x0: 1100, y0: 0, x1: 1200, y1: 10 }), false);
});
