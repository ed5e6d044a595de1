import assert from "node:assert/strict";
import test from "node:test";

import { deleteMeant } from "../../../static/editor/state/edits.js";
import { capOf } from "../support/caps.js";
import { openState, storedShape } from "../support/state.js";

/** @type {(x: number) => import("../../../static/editor/geometry/shapes.js").Shape} */
const at = (x) => storedShape(`at ${x}`, capOf([x, 0, x + 9, 0, x, 9]));

function three() {
  const { state } = openState({ shapes: [at(0), at(20), at(40)] });
  return { state, left: () => state.items.all.map(({ uid }) => uid) };
}

test("Delete removes the cap that is pointed at, though another is selected, and pressed again no other", () => {
  const { state, left } = three();
  state.select(["at 0"]);
  state.selection.hover("at 20");
  deleteMeant(state);
  deleteMeant(state);
  assert.deepEqual([left(), [...state.selection.uids]], [["at 0", "at 40"], []]);
});

test("what is selected after the pointer came to rest is meant before what lies under it", () => {
  const { state, left } = three();
  state.selection.hover("at 20");
  state.select(["at 0"]);
  deleteMeant(state);
  assert.deepEqual(left(), ["at 20", "at 40"]);
});

test("several that are selected are meant before one that is pointed at", () => {
  const { state, left } = three();
  state.select(["at 0", "at 40"]);
  state.selection.hover("at 20");
  deleteMeant(state);
  assert.deepEqual(left(), ["at 20"]);
});

test("what is hidden is not deleted", () => {
  const { state, left } = three();
  state.selection.hover("at 20");
  state.layers.allHidden = true;
  deleteMeant(state);
  assert.equal(left().length, 3);
});
