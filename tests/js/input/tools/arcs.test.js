import assert from "node:assert/strict";
import test from "node:test";

import { ArcsTool } from "../../../../static/editor/input/tools/arcs.js";
import { movedCap } from "../../../../static/editor/geometry/caps.js";
import { capOf } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

const BOX = [200, 200, 300, 200, 300, 260, 200, 260];
const TOP = [200, 200, 250, 200, 300, 200];
const REST = [300, 230, 300, 260, 250, 260, 200, 260, 200, 230];

/** The box is selected, and the server has told its arcs. */
function explained() {
  const { state, committed } = openState({ shapes: [storedShape("box", capOf(BOX))] });
  const fit = { whole: null, centre: null, centre_sd: null, refusal: null };
  const arcs = [
    { kind: /** @type {const} */ ("visible"), points: TOP, told: false },
    { kind: /** @type {const} */ ("concave"), points: REST, told: false },
  ];
  state.select(["box"]);
  state.fitted = { type: "fit", seq: 1, annotation: "box", fit, arcs, note: "", mark: null };
  const tool = new ArcsTool(state, () => {});
  return { state, committed, tool, hand: handOf(state, tool), said: () => state.sole?.cap.arcs };
}

test("a click makes a piece of the rim the next kind, and again, each in a step of its own", () => {
  const { hand, committed, said } = explained();
  const kinds = [];
  for (let i = 0; i < 5; i++) {
    hand.click([250, 200]);
    kinds.push(said()?.map(({ kind }) => kind));
  }
  assert.deepEqual(kinds, [["hidden"], ["border"], ["contact"], ["visible"], ["hidden"]]);
  assert.deepEqual([committed.length, said()?.[0].points], [5, TOP]);
});

test("a drag along the rim names the stretch that it runs along, on the outline itself", () => {
  const { hand, said } = explained();
  hand.stroke([
    [220, 203],
    [240, 198],
    [260, 202],
  ]);
  assert.deepEqual(said(), [{ kind: "hidden", points: [220, 200, 240, 200, 260, 200] }]);
});

test("a drag that begins beside the rim names nothing, a click there selects", () => {
  const { hand, state, committed } = explained();
  hand.stroke([
    [250, 230],
    [250, 200],
  ]);
  hand.click([600, 600]);
  assert.deepEqual([committed.length, state.selection.uids.size], [0, 0]);
});

test("Delete takes back what was said of the piece under the pointer, and never the cap", () => {
  const { hand, tool, said, state } = explained();
  hand.click([250, 200]);
  assert.equal(tool.back(), true);
  assert.equal(said(), undefined);
  assert.equal(tool.back(), true);
  assert.equal(state.items.all.length, 1);
});

test("what was said moves with the cap", () => {
  const moved = movedCap({ ...capOf(BOX), arcs: [{ kind: "hidden", points: TOP }] }, 5, -1);
  assert.deepEqual(moved.arcs, [{ kind: "hidden", points: [205, 199, 255, 199, 305, 199] }]);
});
