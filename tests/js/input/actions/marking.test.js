import assert from "node:assert/strict";
import test from "node:test";

import { flag } from "../../../../static/editor/input/actions/marking.js";
import { capOf, prediction } from "../../support/caps.js";
import { openState, storedShape } from "../../support/state.js";

const STALK = [100, 0, 109, 0, 100, 9];

function three() {
  const at = (/** @type {number} */ x) => storedShape(`at ${x}`, capOf([x, 0, x + 9, 0, x, 9]));
  const { state } = openState({ shapes: [at(0), at(20)], predictions: [prediction(7, [STALK])] });
  const ignored = () => state.items.all.filter(({ cap }) => cap.ignored).map(({ uid }) => uid);
  return { state, ignored };
}

test("with nothing selected the cap under the pointer is ignored, and no longer when that is said again", () => {
  const { state, ignored } = three();
  state.selection.hover("at 20");
  flag(state, "ignored");
  assert.deepEqual([ignored(), [...state.selection.uids]], [["at 20"], []]);
  flag(state, "ignored");
  assert.deepEqual(ignored(), []);
});

test("what is selected is meant before what lies under the pointer, and what is hidden is not meant", () => {
  const { state, ignored } = three();
  state.select(["at 0"]);
  state.selection.hover("at 20");
  flag(state, "ignored");
  assert.deepEqual(ignored(), ["at 0"]);
  state.select([]);
  state.selection.hover("at 20");
  state.layers.allHidden = true;
  flag(state, "ignored");
  assert.deepEqual(ignored(), ["at 0"]);
});

test("an open prediction under the pointer becomes an ignored cap", () => {
  const { state, ignored } = three();
  state.selection.hover("prediction:7");
  flag(state, "ignored");
  assert.equal(ignored().length, 1);
});
