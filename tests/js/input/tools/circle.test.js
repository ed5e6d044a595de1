import assert from "node:assert/strict";
import test from "node:test";

import { polygonOfCircle } from "../../../../static/editor/geometry/caps.js";
import { areaOf } from "../../../../static/editor/geometry/regions.js";
import { CircleTool } from "../../../../static/editor/input/tools/circle.js";
import { capOf } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

/** A circle of 50 around (200, 200), of which what lies right of x = 180 is under a neighbour. */
const HALF_HIDDEN = polygonOfCircle({ kind: "circle", cx: 200, cy: 200, r: 50 }).map((value, i) =>
  i % 2 === 0 ? Math.min(value, 180) : value,
);
const NEIGHBOUR = polygonOfCircle({ kind: "circle", cx: 232, cy: 200, r: 52 });
const SHAPES = [storedShape("hidden", capOf(HALF_HIDDEN)), storedShape("neighbour", capOf(NEIGHBOUR))];

function marking(shapes = SHAPES) {
  const { state, committed } = openState({ shapes });
  const tool = new CircleTool(state);
  const hand = handOf(state, tool);
  const made = () => committed.flat().map(({ after }) => ({ uid: after.uid, mark: after.cap.mark }));
  return { state, tool, hand, made };
}

/** @type {(cx: number, cy: number, r: number) => import("../../../../static/editor/protocol.js").Circle} */
const circle = (cx, cy, r) => ({ kind: "circle", cx, cy, r });

test("a circle around the selected cap is its mark, though its centre lies under the neighbour", () => {
  const { state, hand, made } = marking();
  state.select(["hidden"]);
  hand.stroke([
    [200, 200],
    [230, 200],
    [250, 200],
  ]);
  assert.deepEqual(made(), [{ uid: "hidden", mark: circle(200, 200, 50) }]);
  assert.deepEqual([...state.selection.uids], ["hidden"]);
});

test("circles over buds that touch are a cap each, though the last one is selected", () => {
  const { state, hand, made } = marking();
  for (const [x, r] of [
    [600, 20],
    [628, 10],
    [645, 8],
    [620, 6],
  ]) {
    hand.stroke([
      [x, 400],
      [x + r, 400],
    ]);
  }
  assert.deepEqual(
    made().map(({ mark }) => mark),
    [circle(600, 400, 20), circle(628, 400, 10), circle(645, 400, 8), circle(620, 400, 6)],
  );
  assert.equal(new Set(made().map(({ uid }) => uid)).size, 4);
  assert.equal(state.selection.uids.size, 1);
});

test("undo while a circle is dragged out lets it go, and nothing else", () => {
  const { tool, hand, made } = marking();
  hand.down([600, 400]);
  hand.drag([630, 400]);
  assert.equal(tool.undo(), true);
  hand.drag([660, 400]);
  hand.up([660, 400]);
  assert.deepEqual(made(), []);
  assert.equal(tool.undo(), false);
});

test("a tool that is taken up while a circle is dragged out leaves the circle where it is", () => {
  const { tool, hand, made } = marking();
  hand.down([600, 400]);
  hand.drag([630, 400]);
  tool.leave();
  assert.deepEqual(
    made().map(({ mark }) => mark),
    [circle(600, 400, 30)],
  );
});

test("a circle on free ground is a cap of which all is seen; beside a neighbour, what that leaves", () => {
  const { state, hand } = marking();
  hand.stroke([
    [600, 400],
    [630, 400],
  ]);
  hand.stroke([
    [232, 120],
    [282, 120],
  ]);
  const [free, beside] = state.items.all.slice(-2).map(({ cap }) => areaOf(cap.visible));
  assert.ok(Math.abs(free - Math.PI * 30 ** 2) < 40, String(free));
  // Two circles of 50 and 52 whose centres are 80 apart share 950 px².
  assert.ok(Math.abs(beside - (Math.PI * 50 ** 2 - 950)) < 60, String(beside));
});

test("a half-hidden cap that is selected gets the circle, wherever that was begun, as long as it goes round any of it", () => {
  const sliver = polygonOfCircle({ kind: "circle", cx: 200, cy: 200, r: 50 }).map((value, i) =>
    i % 2 === 0 ? Math.min(value, 160) : value,
  );
  const whole = circle(190, 200, 46);
  const { state, hand, made } = marking([/** @type {any} */ ({ ...storedShape("sliver", capOf(sliver)), whole })]);
  state.select(["sliver"]);
  hand.stroke([
    [215, 200],
    [275, 200],
  ]);
  assert.deepEqual(made(), [{ uid: "sliver", mark: circle(215, 200, 60) }]);
  hand.stroke([
    [600, 600],
    [630, 600],
  ]);
  assert.equal(made().length, 2);
  assert.notEqual(made()[1].uid, "sliver");
});
