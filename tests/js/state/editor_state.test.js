import assert from "node:assert/strict";
import { mock, test } from "node:test";

import { changed } from "../../../static/editor/state/changes.js";
import {
  accept,
  acceptSelected,
  changeSelected,
  deleteSelected,
  nudge,
} from "../../../static/editor/state/edits.js";
import { movedShape } from "../../../static/editor/geometry/shapes.js";
import { SQUARE, capOf, prediction, triangle } from "../support/caps.js";
import { openState, storedShape } from "../support/state.js";

/** @typedef {import("../../../static/editor/geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../../static/editor/state/changes.js").Change} Change */
/** @typedef {import("../../../static/editor/state/editor_state.js").EditorState} EditorState */

const U = storedShape("u", capOf(triangle(100)));
const V = storedShape("v", capOf(triangle(200)));

/** @type {(state: EditorState, uid: string, by: number) => void} */
function drag(state, uid, by) {
  const shape = state.items.get(uid);
  assert.ok(shape);
  state.propose([movedShape(shape, by, 0)]);
}

/** The first x of what was committed. @type {(changes: Change[]) => number[]} */
const places = (changes) => changes.map(({ after }) => after.cap.visible[0][0]);

test("what is being dragged is shown where it is dragged to and committed once, when it is let go", () => {
  const { state, committed } = openState({ shapes: [U, V] });
  state.select(["u"]);
  drag(state, "u", 5);
  drag(state, "u", 7);
  assert.equal(state.sole?.cap.visible[0][0], 107);
  assert.deepEqual(committed, []);
  state.commitDrafts();
  assert.deepEqual(committed.map(places), [[107]]);
  assert.equal(state.items.get("u")?.cap.visible[0][0], 107);
});

test("a drag that is called off leaves the caps as they were, and their place is drawn anew", () => {
  const { state, committed } = openState({ shapes: [U, V] });
  state.select(["u", "v"]);
  state.propose([movedShape(U, 500, 0), movedShape(V, 500, 0)]);
  /** @type {number[][]} */
  const drawn = [];
  state.signals.shapes.listen((shapes) => drawn.push(shapes.map(({ cap }) => cap.visible[0][0])));
  state.withdraw();
  assert.deepEqual([committed, drawn], [[], [[100, 200]]]);
  assert.deepEqual(places(state.selected.map((after) => ({ before: null, after }))), [100, 200]);
});

test("a burst of arrow keys is one step, and counts as unsaved until it is committed", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { state, committed } = openState({ shapes: [U] });
  state.select(["u"]);
  for (let i = 0; i < 3; i++) {
    nudge(state, 0.25, 0);
    context.mock.timers.tick(300);
  }
  assert.deepEqual([state.drafts.waiting, committed], [1, []]);
  context.mock.timers.tick(200);
  assert.deepEqual(committed.map(places), [[100.75]]);
  assert.equal(state.drafts.waiting, 0);
});

test("selecting something else commits what was being changed", () => {
  const { state, committed } = openState({ shapes: [U, V] });
  state.select(["u"]);
  drag(state, "u", 3);
  state.select(["v"]);
  assert.deepEqual(committed.map(places), [[103]]);
  assert.deepEqual([...state.selection.uids], ["v"]);
});

test("a cap that somebody else deletes is deselected, the others stay", () => {
  const { state } = openState({ shapes: [U, V] });
  state.select(["u", "v"]);
  state.store.apply([{ before: U, after: { ...U, deleted: true } }]);
  assert.deepEqual([...state.selection.uids], ["v"]);
});

/** Somebody else's change of a stored cap comes in. @type {(state: EditorState, after: Partial<Shape>) => void} */
function comeIn(state, after) {
  const before = state.items.get("u");
  if (before) state.store.apply([{ before, after: { ...before, ...after } }]);
}

/** The revisions on which what was committed was made. @type {(committed: Change[][]) => (number | undefined)[]} */
const bases = (committed) => committed.flat().map(({ before }) => before?.revision);

test("a drag and a nudge are of the revision they were begun on, whatever comes in meanwhile", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { state, committed } = openState({ shapes: [{ ...U, revision: 13 }] });
  state.select(["u"]);
  drag(state, "u", 5);
  comeIn(state, { revision: 14 });
  state.commitDrafts();
  comeIn(state, { revision: 20 });
  nudge(state, 1, 0);
  comeIn(state, { revision: 21 });
  context.mock.timers.tick(500);
  assert.deepEqual(bases(committed), [13, 20]);
});

test("what was taken hold of before the change came in is of the old revision, also where it moves later", () => {
  const { state, committed } = openState({ shapes: [{ ...U, revision: 13 }] });
  state.select(["u"]);
  const held = state.selected[0];
  comeIn(state, { revision: 14 });
  state.propose([movedShape(held, 5, 0)]);
  state.commitDrafts();
  assert.deepEqual(bases(committed), [13]);
});

test("a tool that changes the cap only when the pointer is let go changes it as it was when it was pressed", () => {
  const { state, committed } = openState({ shapes: [{ ...U, revision: 13 }] });
  state.select(["u"]);
  state.beginGesture();
  comeIn(state, { revision: 14 });
  for (let i = 0; i < 2; i++) {
    const [shape] = state.selected;
    state.commit([changed(shape, { ...shape, cap: { ...shape.cap, doubtful: i === 0 } })]);
    state.endGesture();
  }
  assert.deepEqual(bases(committed), [13, 14]);
});

test("a cap that somebody deletes while it is dragged stays in hand, and is committed when it is let go", () => {
  const { state, committed } = openState({ shapes: [{ ...U, revision: 13 }] });
  state.select(["u"]);
  drag(state, "u", 5);
  comeIn(state, { revision: 14, deleted: true });
  assert.deepEqual([[...state.selection.uids], committed], [["u"], []]);
  state.commitDrafts();
  assert.deepEqual([bases(committed), committed[0][0].after.deleted], [[13], false]);
});

test("a fresh copy of the image, after a break, leaves what is being nudged in hand", () => {
  const { state, committed } = openState({ shapes: [U] });
  state.select(["u"]);
  nudge(state, 2, 0);
  const { image } = state;
  assert.ok(image);
  state.store.replace([{ ...U, revision: 3 }]);
  state.open({ image, annotations: [], predictions: [], run: null, unchecked: [] });
  state.commitDrafts();
  assert.deepEqual([committed.map(places), bases(committed)], [[[102]], [U.revision]]);
});

test("the selection follows predictions that become annotations", () => {
  const { state, committed } = openState({ predictions: [prediction(1), prediction(2)] });
  state.select(["prediction:2"]);
  state.selection.activate({ kind: "vertex", vertices: [{ ring: 0, index: 1 }] });
  drag(state, "prediction:2", 5);
  state.commitDrafts();
  const [[{ after }]] = committed;
  assert.deepEqual([...state.selection.uids], [after.uid]);
  assert.equal(state.selection.handle?.kind, "vertex");
  assert.deepEqual([after.cap.prediction, after.score, after.cap.visible[0][0]], [2, null, 5]);
});

test("a prediction that was nudged and then accepted is accepted once", () => {
  const { state } = openState({ predictions: [prediction(1)] });
  state.select(["prediction:1"]);
  nudge(state, 1, 0);
  acceptSelected(state);
  assert.deepEqual(
    state.store.live().map(({ cap }) => [cap.prediction, cap.visible[0][0]]),
    [[1, 1]],
  );
});

test("accepting all takes up every open prediction and nothing twice", () => {
  const { state, committed } = openState({ shapes: [U], predictions: [prediction(1), prediction(2)] });
  state.select(["prediction:1"]);
  nudge(state, 1, 0);
  accept(state, state.visible);
  accept(state, state.visible);
  const taken = committed.flat().map(({ after }) => after.cap.prediction);
  assert.deepEqual(taken.sort(), [1, 2]);
});

test("deleting a prediction turns it down, deleting an annotation deletes it", () => {
  const { state, committed } = openState({ shapes: [U], predictions: [prediction(1)] });
  state.select(["u", "prediction:1"]);
  deleteSelected(state);
  assert.deepEqual(
    committed[0].map(({ after }) => [after.deleted, after.cap.prediction]),
    [
      [true, null],
      [true, 1],
    ],
  );
  assert.deepEqual([state.items.all, [...state.selection.uids]], [[], []]);
});

test("a change of the selected caps is one step, and leaves alone what it says null of", () => {
  const doubtful = storedShape("v", { ...capOf(SQUARE), doubtful: true });
  const { state, committed } = openState({ shapes: [U, doubtful] });
  state.select(["u", "v"]);
  changeSelected(state, (cap) => (cap.doubtful ? null : { ...cap, doubtful: true }));
  assert.deepEqual(
    committed.map((changes) => changes.map(({ after }) => after.uid)),
    [["u"]],
  );
});

test("a later run takes the place of an earlier one and of its selection", () => {
  const { state } = openState({ predictions: [prediction(1)] });
  state.select(["prediction:1"]);
  state.predict([prediction(7), prediction(8)]);
  assert.deepEqual(
    state.items.all.map(({ uid }) => uid),
    ["prediction:7", "prediction:8"],
  );
  assert.deepEqual([...state.selection.uids], []);
});

test("a later run leaves the selection of an annotation and its handle alone", () => {
  const { state } = openState({ shapes: [U] });
  state.select(["u"]);
  state.selection.activate({ kind: "centre" });
  const told = mock.fn();
  state.signals.selection.listen(told);
  state.predict([prediction(7)]);
  assert.deepEqual([[...state.selection.uids], state.selection.handle], [["u"], { kind: "centre" }]);
  assert.equal(told.mock.callCount(), 0);
});

test("a prediction that is being dragged stays until it is let go", () => {
  const { state, committed } = openState({ predictions: [prediction(1), prediction(2)] });
  state.select(["prediction:1"]);
  drag(state, "prediction:1", 5);
  state.predict([prediction(7)]);
  state.commitDrafts();
  assert.deepEqual(
    committed.flat().map(({ after }) => [after.cap.prediction, after.cap.visible[0][0]]),
    [[1, 5]],
  );
});

test("a fresh copy of the same image keeps the selection, and tells of it once", () => {
  const { state } = openState({ shapes: [U, V] });
  state.select(["u"]);
  const told = mock.fn();
  state.signals.selection.listen(told);
  assert.ok(state.image);
  state.open({ image: state.image, annotations: [], predictions: [], run: null, unchecked: [] });
  assert.deepEqual([[...state.selection.uids], told.mock.callCount()], [["u"], 1]);
  state.open({ image: { ...state.image, id: 2 }, annotations: [], predictions: [], run: null, unchecked: [] });
  assert.deepEqual([[...state.selection.uids], told.mock.callCount()], [[], 2]);
});

test("every image is found again as it was left", () => {
  const { state } = openState();
  const { viewport, image } = state;
  assert.ok(image);
  const other = { ...image, id: 2 };
  viewport.resize({ width: 1000, height: 800 });
  viewport.zoomAt(300, 300, 4);
  const left = viewport.view;
  state.open({ image: other, annotations: [], predictions: [], run: null, unchecked: [] });
  assert.notDeepEqual(viewport.view, left);
  state.open({ image, annotations: [], predictions: [], run: null, unchecked: [] });
  assert.deepEqual(viewport.view, left);
});

test("a cap that the pointer was on is not pointed at once a key has moved the photo; panned or zoomed by the pointer it is", () => {
  const { state } = openState({ shapes: [U] });
  state.viewport.resize({ width: 1000, height: 800 });
  const { viewport, selection } = state;
  const after = (/** @type {() => void} */ move) => {
    selection.hover("u");
    move();
    return selection.hovered;
  };
  const led = [() => viewport.panBy(30, 0), () => viewport.zoomAt(100, 100, 2)];
  const alone = [() => viewport.zoomBy(2), () => viewport.showAll()];
  assert.deepEqual([...led, ...alone].map(after), ["u", "u", null, null]);
});
