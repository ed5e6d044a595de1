import assert from "node:assert/strict";
import test from "node:test";

import { History } from "../../../static/editor/state/history.js";
import { capOf, shapeOf, triangle } from "../support/caps.js";

/** @typedef {import("../../../static/editor/geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../../static/editor/state/history.js").ChangeSet} ChangeSet */

const U = { ...shapeOf("u", triangle(0)), revision: 3 };
const V = shapeOf("v", triangle(3));

/** A shape at another place. @type {(shape: Shape, x: number) => Shape} */
const at = (shape, x) => ({ ...shape, cap: capOf(triangle(x)) });
/** @type {(id: string, ...changes: [Shape | null, Shape][]) => ChangeSet} */
const set = (id, ...changes) => {
  return { ids: [id], changes: changes.map(([before, after]) => ({ before, after })), status: null };
};

test("undoing is made on the revision that the cap has now, and says what it takes back", () => {
  const history = new History();
  history.push(set("moved", [U, at(U, 9)]));
  const now = { ...at(U, 9), revision: 8 };
  assert.deepEqual(
    history.undo("back", () => now),
    { takesBack: "moved", changes: [{ before: now, after: { ...U, revision: 8 } }], status: null, verdict: null },
  );
  assert.deepEqual(history.depth, { undo: 0, redo: 1 });
  const again = history.redo("again", () => ({ ...U, revision: 9 }));
  assert.deepEqual([again?.takesBack, again?.changes[0].after], ["back", { ...at(U, 9), revision: 9 }]);
  assert.equal(history.undo("back again", () => now)?.takesBack, "again");
});

test("a change of status is undone as one of caps is", () => {
  const history = new History();
  history.push({ ids: ["said"], changes: [], status: { before: "new", after: "annotated" } });
  assert.deepEqual(history.undo("back", () => null)?.status, { before: "annotated", after: "new" });
  assert.deepEqual(history.redo("again", () => null)?.status, { before: "new", after: "annotated" });
  history.forgetStatus();
  assert.equal(
    history.undo("none", () => null),
    null,
  );
});

test("a new change ends what could be redone; what others changed cannot be undone", () => {
  const history = new History();
  history.push(set("a", [U, at(U, 9)]));
  history.undo("b", () => at(U, 9));
  history.push(set("c", [U, at(U, 9)], [null, V]));
  assert.equal(
    history.redo("d", () => U),
    null,
  );
  history.forget(new Set(["u"]));
  assert.deepEqual(
    history.undo("e", () => V)?.changes.map(({ after }) => after.uid),
    ["v"],
  );
  assert.equal(
    history.undo("f", () => V),
    null,
  );
});

test("a refused change takes nothing else of the cap's history, and nothing of other caps, with it", () => {
  const history = new History();
  const [first, bad, flagged] = [at(U, 30), at(U, -99), at(U, -99)];
  history.push(set("moved", [U, first]));
  history.push(set("refused", [first, bad], [null, V]));
  history.push(set("flagged", [bad, { ...flagged, cap: { ...flagged.cap, doubtful: true } }]));
  history.refused("refused", "u", (cap) => ({ ...cap, visible: first.cap.visible }));
  const undone = ["x", "y", "z"].map((id) => history.undo(id, (uid) => (uid === "u" ? first : V)));
  assert.deepEqual(
    undone.map((move) => move?.changes.map(({ after }) => [after.uid, after.cap.visible[0][0], after.deleted])),
    [[["u", 30, false]], [["v", 3, true]], [["u", 0, false]]],
  );
});

test("a change that was taken back before it was refused is not done again", () => {
  const history = new History();
  history.push(set("moved", [U, at(U, 30)]));
  history.push(set("refused", [at(U, 30), at(U, -99)]));
  history.undo("back", () => at(U, -99));
  history.refused("refused", "u", (cap) => cap);
  assert.deepEqual(history.depth, { undo: 1, redo: 0 });
});
