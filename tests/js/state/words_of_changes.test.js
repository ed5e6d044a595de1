import assert from "node:assert/strict";
import test from "node:test";

import { wordsOfChanges } from "../../../static/editor/state/words_of_changes.js";
import { capOf, shapeOf, triangle } from "../support/caps.js";

const U = shapeOf("u", triangle(0));
const V = shapeOf("v", triangle(3));
const OF_PREDICTION = { ...V, cap: { ...V.cap, prediction: 7 } };

/** @type {(shape: import("../../../static/editor/geometry/shapes.js").Shape) => typeof shape} */
const gone = (shape) => ({ ...shape, deleted: true });

test("caps that come and go are counted", () => {
  assert.equal(wordsOfChanges([{ before: null, after: U }]), "drew a cap");
  assert.equal(
    wordsOfChanges([
      { before: U, after: gone(U) },
      { before: gone(V), after: OF_PREDICTION },
      { before: V, after: gone(V) },
    ]),
    "deleted 2 caps, accepted a prediction",
  );
  assert.equal(wordsOfChanges([{ before: null, after: gone(OF_PREDICTION) }]), "turned down a prediction");
});

test("of a cap that stays it is said what is another about it", () => {
  const circle = { kind: /** @type {const} */ ("circle"), cx: 1, cy: 2, r: 3 };
  const marked = { ...U, cap: { ...U.cap, mark: circle, doubtful: true } };
  assert.equal(wordsOfChanges([{ before: U, after: marked }]), "placed the mark of a cap, set a cap to doubtful");
  assert.equal(
    wordsOfChanges([{ before: marked, after: { ...U, cap: capOf(triangle(9)) } }]),
    "changed the outline of a cap, cleared the mark of a cap, set a cap to not doubtful",
  );
  assert.equal(wordsOfChanges([{ before: U, after: { ...U, revision: 4 } }]), "");
});
