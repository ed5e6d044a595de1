import assert from "node:assert/strict";
import test from "node:test";

import { areaOfRing, newCap, polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { GAP_PX, mergedOutline, splitCap } from "../../../static/editor/geometry/cuts.js";
import { capOf } from "../support/caps.js";
import { pointsOf } from "../support/plane.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

const BOX = [0, 0, 100, 0, 100, 60, 0, 60];
const HOW = { reach: 5, tolerance: 0.5 };
/** Across the box at x = 30, from above it to below it. @type {Point[]} */
const ACROSS = [
  [30, -10],
  [30, 20],
  [30, 40],
  [30, 70],
];

/** @type {(stroke: Point[], cap?: import("../../../static/editor/protocol.js").Cap) => number[] | null} */
function areas(stroke, cap = capOf(BOX)) {
  return splitCap(cap, stroke, HOW)?.caps.map(({ visible }) => areaOfRing(visible[0])) ?? null;
}

test("a stroke across a cap makes two of it, the larger first, and loses nothing", () => {
  assert.deepEqual(areas(ACROSS), [4200, 1800]);
  assert.deepEqual(areas(ACROSS.toReversed()), [4200, 1800]);
});

test("an end that lies within, but near the rim, is drawn on to it as the stroke runs there", () => {
  // The box is as wide as a circle of 87 px; a quarter of that is 22.
  const within = ACROSS.slice(1, 3);
  for (const stroke of [ACROSS.slice(0, 3), ACROSS.slice(1), [...within, [30, 42]], [[30, 40], [30, 30], [30, 18]]])
    assert.deepEqual(areas(/** @type {Point[]} */ (stroke)), [4200, 1800]);
  const slanting = splitCap(capOf(BOX), [[20, -5], [20, 20], [30, 40], [35, 50]], HOW);
  const ends = pointsOf(slanting?.caps[1].visible[0] ?? []).map((at) => at.map(Math.round).join());
  assert.ok(ends.includes("20,0") && ends.includes("40,60"), String(ends));
});

test("a stroke that ends far within, or runs beside, splits nothing", () => {
  assert.equal(areas([...ACROSS.slice(0, 2), [30, 34]]), null);
  assert.equal(areas([[30, 26], ...ACROSS.slice(2)]), null);
  assert.equal(areas(ACROSS.map(([x, y]) => [x - 60, y])), null);
});

test("the larger piece keeps what is known; a mark goes with the piece that its centre lies in", () => {
  const known = { visible: [BOX], prediction: 7, order: 2, doubtful: true };
  const far = splitCap(newCap({ ...known, mark: { kind: "circle", cx: 70, cy: 30, r: 40 } }), ACROSS, HOW);
  assert.deepEqual(far?.caps.map(({ prediction, order, doubtful, mark }) => [prediction, order, doubtful, mark?.kind]), [
    [7, 2, true, "circle"],
    [null, null, false, undefined],
  ]);
  const near = splitCap(newCap({ ...known, mark: { kind: "circle", cx: 15, cy: 30, r: 40 } }), ACROSS, HOW);
  assert.deepEqual(near?.caps.map(({ mark }) => mark?.kind), [undefined, "circle"]);
});

test("of a cap of two parts the one that is crossed is split, and the other stays with the larger piece", () => {
  const other = BOX.map((value, i) => (i % 2 ? value + 200 : value));
  const [larger, smaller] = splitCap(capOf(other, BOX), ACROSS, HOW)?.caps ?? [];
  assert.deepEqual([larger?.visible.length, smaller?.visible.length], [2, 1]);
});

test("caps become one across a gap of a few pixels; farther apart they become two parts of one", () => {
  const round = (/** @type {number} */ cx) => capOf(polygonOfCircle({ kind: "circle", cx, cy: 50, r: 40 }));
  assert.equal(mergedOutline([round(50), round(100)]).length, 1);
  assert.equal(mergedOutline([capOf(BOX), capOf(BOX.map((v, i) => (i % 2 ? v : v + 100 + GAP_PX - 1)))]).length, 1);
  assert.equal(mergedOutline([round(50), round(150)]).length, 2);
});
