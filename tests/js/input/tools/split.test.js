import assert from "node:assert/strict";
import test from "node:test";

import { areaOf } from "../../../../static/editor/geometry/regions.js";
import { splitTool } from "../../../../static/editor/input/tools/split.js";
import { capOf, prediction } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

const BOX = [200, 200, 300, 200, 300, 260, 200, 260];
/** @type {Point[]} */
const ACROSS = [
  [230, 190],
  [231, 215],
  [230, 240],
  [230, 270],
];

/** @type {(contents: Parameters<typeof openState>[0]) => any} */
function splitting(contents) {
  const { state, committed } = openState(contents);
  /** @type {string[]} */
  const said = [];
  const hand = handOf(state, splitTool(state, (text) => void said.push(text)));
  return { state, committed, said, hand };
}

test("a stroke across a cap makes two of it in one step; the larger keeps its name and is selected", () => {
  const { state, committed, hand } = splitting({ shapes: [storedShape("box", capOf(BOX))] });
  hand.stroke(ACROSS);
  assert.equal(committed.length, 1);
  const areas = state.items.all.map((/** @type {any} */ { uid, cap }) => [uid === "box", Math.round(areaOf(cap.visible) / 100)]);
  assert.deepEqual(areas, [
    [true, 42],
    [false, 18],
  ]);
  assert.deepEqual([...state.selection.uids], ["box"]);
});

test("of a prediction only the larger piece started from it", () => {
  const { state, hand } = splitting({ predictions: [prediction(3, [BOX])] });
  hand.stroke(ACROSS);
  const links = state.items.all.map((/** @type {any} */ { cap, score }) => [cap.prediction, score]);
  assert.deepEqual(links, [
    [3, null],
    [null, null],
  ]);
});

test("a stroke that crosses no cap changes nothing and says so", () => {
  const { committed, said, hand } = splitting({ shapes: [storedShape("box", capOf(BOX))] });
  hand.stroke(ACROSS.map(([x, y]) => [x + 200, y]));
  assert.deepEqual([committed.length, said.length], [0, 1]);
});

test("a stroke that stops far inside a cap changes nothing, and what is said tells why", () => {
  const { committed, said, hand } = splitting({ shapes: [storedShape("box", capOf(BOX))] });
  const far = /** @type {Point[]} */ ([[230, 190], [230, 205], [230, 215], [230, 225]]);
  hand.stroke(far);
  hand.stroke(far.toReversed());
  assert.equal(committed.length, 0);
  assert.match(said[0], /ends far inside/);
  assert.match(said[1], /begins far inside/);
});

test("of two caps that a stroke crosses the one is split across which it runs longest, unless one is selected", () => {
  const low = [200, 260, 300, 260, 300, 290, 200, 290];
  const shapes = [storedShape("box", capOf(BOX)), storedShape("low", capOf(low))];
  const way = /** @type {Point[]} */ ([[230, 190], [231, 215], [230, 240], [230, 275], [230, 300]]);
  const { committed, hand, state } = splitting({ shapes });
  hand.stroke(way);
  state.select(["low"]);
  hand.stroke(way.map(([x, y]) => [x + 40, y]));
  assert.deepEqual(committed.map((/** @type {any} */ [{ after }]) => after.uid), ["box", "low"]);
});
