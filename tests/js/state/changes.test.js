import assert from "node:assert/strict";
import test from "node:test";

import { changed, inverse, stepsOf } from "../../../static/editor/state/changes.js";
import { capOf, shapeOf, triangle } from "../support/caps.js";

const U = { ...shapeOf("u", triangle(0)), revision: 3 };
const MOVED = { ...U, cap: capOf(triangle(9)) };

test("an annotation is changed in place; a prediction gives way to an annotation of another uid", () => {
  assert.deepEqual(changed(U, MOVED), { before: U, after: MOVED });
  const predicted = { ...shapeOf("prediction:7", triangle(0)), score: 0.8 };
  const { before, after } = changed(predicted, predicted);
  assert.equal(before, null);
  assert.deepEqual({ ...after, uid: "prediction:7", score: 0.8 }, predicted);
  assert.match(after.uid, /^[0-9a-f]{24}$/);
});

test("a deletion is sent as such where the server has the cap, however its fields are ordered", () => {
  const reordered = Object.fromEntries(Object.entries(U.cap).reverse());
  const deleted = { ...U, cap: /** @type {typeof U.cap} */ (reordered), deleted: true };
  assert.deepEqual(stepsOf({ before: U, after: deleted }), [null]);
});

test("a cap that was changed and deleted, or never made, is sent before it is deleted", () => {
  const deleted = { ...MOVED, deleted: true };
  assert.deepEqual(stepsOf({ before: U, after: deleted }), [MOVED.cap, null]);
  assert.deepEqual(stepsOf({ before: null, after: deleted }), [MOVED.cap, null]);
  assert.deepEqual(stepsOf({ before: { ...MOVED, deleted: true }, after: deleted }), [MOVED.cap, null]);
});

test("the inverse goes back in the opposite order and gives a prediction free", () => {
  const born = { ...shapeOf("new", triangle(5)), cap: { ...capOf(triangle(5)), prediction: 7 } };
  const back = inverse([
    { before: U, after: MOVED },
    { before: null, after: born },
  ]);
  assert.deepEqual(
    back.map(({ before, after }) => [before?.uid, after.uid, after.deleted, after.cap.prediction]),
    [
      ["new", "new", true, null],
      ["u", "u", false, null],
    ],
  );
  assert.deepEqual(back[1].after, U);
});
