import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import { accept, acceptSelected, deleteSelected, nudge } from "../../../static/editor/state/edits.js";
import { SQUARE, capOf, prediction, triangle } from "../support/caps.js";
import { openState, storedShape } from "../support/state.js";

/** @typedef {import("../../../static/editor/state/editor_state.js").EditorState} EditorState */

const OUTLINED = storedShape("outlined", capOf(triangle(500)));
const CIRCLED = storedShape("circled", newCap({ mark: { kind: "circle", cx: 700, cy: 50, r: 20 } }));
const IGNORED = storedShape("ignored", { ...capOf(triangle(900)), ignored: true });
const CAPS = { shapes: [OUTLINED, CIRCLED, IGNORED], predictions: [prediction(1)] };

/** @type {(state: EditorState, ...layers: string[]) => void} */
function hide(state, ...layers) {
  const hidden = Object.fromEntries(layers.map((layer) => [layer, false]));
  state.layers.visible = { ...state.layers.visible, ...hidden };
}

/** @type {(state: EditorState) => string[]} */
const seen = (state) => state.visible.map(({ uid }) => uid);

test("a prediction is seen as long as the layer of predictions is", () => {
  const { state } = openState(CAPS);
  hide(state, "outline", "fill", "whole", "centre");
  assert.deepEqual(seen(state), ["prediction:1", "ignored"]);
  hide(state, "prediction");
  assert.deepEqual(seen(state), ["ignored"]);
});

test("a cap is seen as long as anything of it is drawn", () => {
  const { state } = openState(CAPS);
  hide(state, "prediction", "outline");
  assert.deepEqual(seen(state), ["outlined", "circled", "ignored"]);
  hide(state, "fill");
  assert.deepEqual(seen(state), ["circled", "ignored"]);
  hide(state, "whole", "centre");
  assert.deepEqual(seen(state), ["ignored"]);
});

test("what is hidden while it is selected is selected no longer, and nothing is done to it", () => {
  const { state, committed } = openState(CAPS);
  state.select(["prediction:1", "ignored"]);
  hide(state, "prediction");
  assert.deepEqual([...state.selection.uids], ["ignored"]);
  state.select(["prediction:1"]);
  deleteSelected(state);
  acceptSelected(state);
  nudge(state, 1, 0);
  assert.deepEqual([committed, [...state.selection.uids]], [[], []]);
});

test("a nudge that was not committed yet is, when its cap is hidden", () => {
  const { state, committed } = openState(CAPS);
  state.select(["prediction:1"]);
  nudge(state, 1, 0);
  hide(state, "prediction");
  assert.deepEqual(
    committed.flat().map(({ after }) => after.cap.visible[0][0]),
    [1],
  );
});

test("hidden predictions are neither accepted, nor picked, nor found by a rectangle", () => {
  const { state, committed } = openState(CAPS);
  hide(state, "prediction");
  accept(state, state.visible);
  assert.deepEqual([committed, state.at([50, 50], 5)], [[], null]);
  assert.deepEqual(state.near({ x0: -1, y0: -1, x1: 101, y1: 101 }), []);
});

test("as long as a key hides all caps nothing is done to any, and afterwards the same are selected", () => {
  const { state, committed } = openState(CAPS);
  state.select(["outlined", "prediction:1"]);
  state.layers.allHidden = true;
  deleteSelected(state);
  accept(state, state.visible);
  nudge(state, 1, 0);
  assert.deepEqual([committed, state.at([50, 50], 5)], [[], null]);
  state.layers.allHidden = false;
  assert.deepEqual(
    state.selected.map(({ uid }) => uid),
    ["outlined", "prediction:1"],
  );
});

test("what becomes of a shown prediction is selected in its place", () => {
  const { state } = openState({ predictions: [prediction(1, [SQUARE])] });
  state.select(["prediction:1"]);
  acceptSelected(state);
  assert.deepEqual(
    state.selected.map(({ cap }) => cap.prediction),
    [1],
  );
});
