import assert from "node:assert/strict";
import test from "node:test";

import { shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { changed } from "../../../static/editor/state/changes.js";
import { untouched } from "../../../static/editor/state/untouched.js";
import { capOf, prediction, shapeOf, triangle } from "../support/caps.js";

/** @typedef {import("../../../static/editor/state/changes.js").Change} Change */

/** A change of the cap of this name. @type {(uid: string) => Change} */
const change = (uid) => {
  const before = shapeOf(uid, triangle(0));
  return changed(before, { ...before, cap: capOf(triangle(1)) });
};

/** Which of the undone steps, named by their caps, are left after a change; the next to be redone is the last. */
/** @type {(undone: string[][], made: Change[]) => string[][]} */
function left(undone, made) {
  const steps = undone.map((uids) => uids.map(change));
  return untouched(steps, (step) => step, made).map((step) => step.map(({ after }) => after.uid));
}

test("what was taken back of other caps can be done again after something new", () => {
  assert.deepEqual(left([["a"], ["b"]], [change("c")]), [["a"], ["b"]]);
});

test("what was taken back of a cap that was changed since cannot be done again", () => {
  assert.deepEqual(left([["a"], ["b"]], [change("b")]), [["a"]]);
});

test("nor can what came after that and concerned a cap of it", () => {
  assert.deepEqual(left([["d"], ["a"], ["a", "b"]], [change("b")]), [["d"]]);
});

test("an acceptance cannot be done again once the prediction has been taken up another time", () => {
  const open = shapeOfPrediction(prediction(5));
  const other = shapeOfPrediction(prediction(6));
  const steps = [[changed(open, open)], [changed(other, other)]];
  const kept = untouched(steps, (step) => step, [changed(open, { ...open, deleted: true })]);
  assert.deepEqual(kept, [steps[1]]);
});
