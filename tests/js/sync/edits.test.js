import assert from "node:assert/strict";
import test from "node:test";

import { editsOfChange, statusAfter, withoutRefused } from "../../../static/editor/sync/edits.js";
import { capOf, shapeOf, triangle } from "../support/caps.js";

/** @typedef {import("../../../static/editor/sync/outbox.js").Edit} Edit */

const WHENCE = { image: 1, changeSet: "s", takesBack: "t" };

test("an edit is made on the revision that its change was begun on, and the next one on that", () => {
  const before = { ...shapeOf("u", triangle(0)), revision: 13 };
  const [moved, gone] = editsOfChange({ before, after: { ...shapeOf("u", triangle(9)), deleted: true } }, WHENCE);
  assert.deepEqual([moved.base, gone.base, gone.cap], [13, 14, null]);
  assert.deepEqual([moved.change_set, gone.takes_back], ["s", "t"]);
  assert.notEqual(moved.id, gone.id);
});

test("an edit of a cap reopens what was approved; a later word on it holds", () => {
  const shared = { id: "e", image: 1, change_set: "", takes_back: "" };
  /** @type {Edit} */
  const edit = { ...shared, annotation: "u", base: 0, cap: capOf(triangle(0)) };
  /** @type {Edit} */
  const approval = { ...shared, before: "annotated", after: "approved" };
  assert.deepEqual(
    [[], [edit], [edit, approval], [approval, edit]].map((edits) => statusAfter("approved", edits)),
    ["approved", "annotated", "approved", "annotated"],
  );
  assert.equal(statusAfter("new", [edit]), "new");
});

test("what was done after a refused edit goes on without what it changed, and keeps the rest", () => {
  const before = capOf(triangle(0));
  const refused = { ...capOf(triangle(-99)), doubtful: true };
  const later = { ...refused, ignored: true, order: 3 };
  assert.deepEqual(withoutRefused(later, { before, refused }), { ...before, ignored: true, order: 3 });
  const redrawn = { ...later, visible: [triangle(5)] };
  assert.deepEqual(withoutRefused(redrawn, { before, refused }).visible, [triangle(5)]);
});
