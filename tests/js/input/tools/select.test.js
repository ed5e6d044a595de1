import assert from "node:assert/strict";
import test from "node:test";

import { rimTool } from "../../../../static/editor/input/tools/rim.js";
import { SelectTool } from "../../../../static/editor/input/tools/select.js";
import { deleteSelected } from "../../../../static/editor/state/edits.js";
import { capOf, prediction } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

const HEXAGON = [100, 50, 150, 100, 150, 160, 100, 210, 50, 160, 50, 100];
const TRIANGLE = [100, 50, 150, 160, 50, 160];

/** @type {(visible?: number[], extra?: Parameters<typeof openState>[0]) => any} */
function selecting(visible = HEXAGON, extra = {}) {
  const { state, committed } = openState({ shapes: [storedShape("u", capOf(visible))], ...extra });
  /** @type {string[]} */
  const said = [];
  const say = (/** @type {string} */ text) => void said.push(text);
  const tool = new SelectTool(state, { say, rim: rimTool(state, say) });
  const hand = handOf(state, tool);
  state.select(["u"]);
  /** What the key does: the tool is asked first. */
  const del = () => tool.back() || deleteSelected(state);
  const points = () => (state.items.get("u")?.cap.visible[0].length ?? 0) / 2;
  return { state, committed, said, tool, hand, del, points };
}

test("Delete over a vertex takes it out, and pressed again at the same place never deletes the cap", () => {
  const { hand, del, points, said } = selecting();
  hand.hover([150, 100]);
  for (let i = 0; i < 4; i++) del();
  assert.deepEqual([points(), said.length], [5, 3]);
});

test("nor does it after Alt and a click, after a twitch, or where the outline has no vertex to spare", () => {
  const { hand, del, points } = selecting();
  hand.hover([150, 100]);
  hand.click([150, 100], { alt: true });
  del();
  hand.hover([155, 104]);
  del();
  assert.equal(points(), 5);
  const triangle = selecting(TRIANGLE);
  triangle.hand.hover([100, 50]);
  for (let i = 0; i < 3; i++) triangle.del();
  assert.equal(triangle.points(), 3);
});

test("vertices that come under the pointer one after the other are taken out one after the other", () => {
  const { hand, del, points } = selecting();
  hand.hover([150, 100]);
  del();
  hand.hover([150, 160]);
  del();
  del();
  assert.equal(points(), 4);
});

test("once the pointer has moved away, or another cap is selected, Delete deletes the cap", () => {
  const { state, hand, del } = selecting();
  hand.hover([150, 100]);
  del();
  hand.hover([300, 300]);
  del();
  assert.equal(state.items.get("u"), null);
  const two = selecting(HEXAGON, {
    shapes: [storedShape("u", capOf(HEXAGON)), storedShape("v", capOf(TRIANGLE.map((value) => value + 300)))],
  });
  two.hand.hover([150, 100]);
  two.del();
  two.state.select(["v"]);
  two.del();
  assert.deepEqual([two.state.items.get("v"), two.points()], [null, 5]);
});

test("a vertex taken out of a prediction makes an annotation of it, which a second Delete leaves alone", () => {
  const { state, hand, del } = selecting(HEXAGON, { predictions: [prediction(1, [HEXAGON])], shapes: [] });
  state.select(["prediction:1"]);
  hand.hover([150, 100]);
  del();
  del();
  assert.deepEqual(
    state.items.all.map((/** @type {any} */ shape) => [
      shape.cap.prediction,
      shape.cap.visible[0].length / 2,
    ]),
    [[1, 5]],
  );
});

test("a vertex that is dropped upon its neighbour becomes one with it, one beside it does not", () => {
  for (const [x, y, left] of [
    [152, 159, 5],
    [150, 150, 6],
  ]) {
    const { hand, points, committed } = selecting();
    hand.stroke([
      [150, 100],
      [150, 130],
      [x, y],
    ]);
    assert.deepEqual([points(), committed.length], [left, 1]);
  }
  const triangle = selecting(TRIANGLE);
  triangle.hand.stroke([
    [100, 50],
    [120, 100],
    [150, 159],
  ]);
  assert.equal(triangle.points(), 3);
});

test("undo while a vertex is dragged lets go of it; a tool that is taken up leaves it where it is", () => {
  const { state, committed, tool, hand } = selecting();
  hand.down([150, 100]);
  hand.drag([180, 100]);
  assert.deepEqual([tool.undo(), state.drafts.all.length], [true, 0]);
  hand.drag([190, 100]);
  hand.up([190, 100]);
  assert.deepEqual(committed, []);
  hand.down([150, 100]);
  hand.drag([180, 100]);
  tool.leave();
  assert.deepEqual(
    committed.flat().map((/** @type {any} */ { after }) => after.cap.visible[0].slice(2, 4)),
    [[180, 100]],
  );
  assert.equal(tool.undo(), false);
});

const UNDER = [60, 60, 140, 60, 140, 150, 60, 150];

test("a click at one place again selects what lies under, and goes round", () => {
  const { state, hand } = selecting(HEXAGON, {
    shapes: [storedShape("u", capOf(HEXAGON)), storedShape("under", capOf(UNDER))],
  });
  state.select([]);
  const found = [0, 1, 2].map((i) => {
    at(1000 * i, () => hand.click([100, 105]));
    return state.selection.soleUid;
  });
  assert.deepEqual(found, ["under", "u", "under"]);
  at(5000, () => hand.click([100, 105]));
  at(5100, () => hand.click([100, 105]));
  assert.equal(state.selection.soleUid, "u", "a double click means one cap");
});

test("a rectangle drawn to the right takes what it encloses, to the left what it touches", () => {
  const { state, hand } = selecting(HEXAGON, {
    shapes: [storedShape("u", capOf(HEXAGON)), storedShape("far", capOf(HEXAGON.map((value) => value + 400)))],
  });
  state.select([]);
  hand.stroke(
    [
      [20, 20],
      [60, 300],
      [120, 300],
    ],
    { shift: true },
  );
  assert.deepEqual([...state.selection.uids], []);
  hand.stroke(
    [
      [120, 300],
      [60, 100],
      [20, 20],
    ],
    { shift: true },
  );
  assert.deepEqual([...state.selection.uids], ["u"]);
  hand.stroke(
    [
      [540, 540],
      [550, 550],
      [560, 560],
      [530, 530],
    ],
    { shift: true },
  );
  assert.deepEqual([...state.selection.uids], ["u", "far"]);
});

/** Does something at a moment. @type {(ms: number, what: () => void) => void} */
function at(ms, what) {
  const { now } = performance;
  performance.now = () => ms;
  try {
    what();
  } finally {
    performance.now = now;
  }
}

test("a click where the ring of the selected cap's mark runs over another cap selects that; a drag moves the ring", () => {
  // Half of a disc around (300, 200), marked whole, and the cap that hides the other half.
  const half = [300, 150, 300, 250, 265, 235, 250, 200, 265, 165];
  const inFront = [300, 150, 400, 150, 400, 250, 300, 250];
  const mark = { kind: /** @type {const} */ ("circle"), cx: 300, cy: 200, r: 50 };
  const shapes = [storedShape("half", { ...capOf(half), mark }), storedShape("front", capOf(inFront))];
  const { state, hand, committed } = selecting(HEXAGON, { shapes });
  state.select(["half"]);
  hand.click([350, 200]);
  assert.deepEqual([...state.selection.uids], ["front"]);
  state.select(["half"]);
  hand.stroke([
    [350, 200],
    [360, 200],
    [370, 200],
  ]);
  const [[{ after }]] = committed;
  assert.equal(after.cap.mark.r, 70);
  assert.deepEqual([...state.selection.uids], ["half"]);
});

test("Delete over a lesser part of the selected cap takes that part; over the largest it takes the cap", () => {
  const sliver = [200, 100, 210, 100, 210, 160, 200, 160];
  const shapes = [storedShape("u", capOf(HEXAGON, sliver))];
  const { state, hand, del } = selecting(HEXAGON, { shapes });
  hand.hover([205, 130]);
  del();
  del();
  assert.deepEqual(state.items.get("u")?.cap.visible, [HEXAGON]);
  hand.hover([100, 130]);
  del();
  assert.equal(state.items.get("u"), null);
});
