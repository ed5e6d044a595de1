import assert from "node:assert/strict";
import test from "node:test";

import { HalfDrawn } from "../../../static/editor/state/half_drawn.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/** @type {Point[]} */
const FOUR = [
  [1, 1],
  [5, 1],
  [5, 5],
  [1, 5],
];

/** @type {(points?: Point[]) => HalfDrawn} */
function drawn(points = FOUR) {
  const outline = new HalfDrawn();
  for (const point of points) outline.add(point);
  return outline;
}

test("undo takes points back one by one, and redo places them again in their order", () => {
  const outline = drawn();
  outline.undo();
  outline.undo();
  assert.deepEqual(outline.points, FOUR.slice(0, 2));
  outline.redo();
  assert.deepEqual(outline.points, FOUR.slice(0, 3));
  outline.redo();
  assert.deepEqual([outline.points, outline.redo()], [FOUR, false]);
});

test("with no point left there is nothing to undo, and everything to redo", () => {
  const outline = drawn(FOUR.slice(0, 1));
  assert.deepEqual(
    [outline.undo(), outline.undo(), outline.empty, outline.canRedo],
    [true, false, true, true],
  );
});

test("a new point ends what could be placed again", () => {
  const outline = drawn();
  outline.undo();
  outline.add([9, 9]);
  assert.deepEqual([outline.redo(), outline.points], [false, [...FOUR.slice(0, 3), [9, 9]]]);
});

test("what was dropped at once comes back at once, by undo as by redo", () => {
  const outline = drawn();
  outline.drop();
  assert.ok(outline.empty);
  outline.undo();
  assert.deepEqual(outline.points, FOUR);
  outline.drop();
  outline.redo();
  assert.deepEqual(outline.points, FOUR);
});

test("of what was begun anew nothing from before can be brought back", () => {
  const outline = drawn();
  outline.drop();
  outline.begin([]);
  assert.deepEqual([outline.undo(), outline.redo(), outline.empty], [false, false, true]);
});

test("every change is told, and what changes nothing is not", () => {
  const outline = new HalfDrawn();
  let told = 0;
  outline.changed.listen(() => told++);
  outline.begin([]);
  outline.drop();
  outline.undo();
  outline.redo();
  assert.equal(told, 0);
  outline.add([1, 1]);
  outline.undo();
  outline.redo();
  assert.equal(told, 3);
});
