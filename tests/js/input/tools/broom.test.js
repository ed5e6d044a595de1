import assert from "node:assert/strict";
import test from "node:test";

import { Broom } from "../../../../static/editor/input/tools/broom.js";
import { capOf, prediction } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @type {(x: number) => number[]} */
const box = (x) => [x, 100, x + 20, 100, x + 20, 120, x, 120];

function sweeping() {
  const shapes = [100, 200, 300, 400].map((x) => storedShape(`at ${x}`, capOf(box(x))));
  const { state, committed } = openState({ shapes, predictions: [prediction(5, [box(500)])] });
  const broom = new Broom(state);
  return { state, committed, broom, hand: handOf(state, broom) };
}

test("what the pointer has run over is deleted when the key is let go, in one step", () => {
  const { state, committed, broom, hand } = sweeping();
  hand.hover([110, 110]);
  hand.hover([310, 110]);
  hand.hover([350, 300]);
  hand.hover([510, 110]);
  assert.equal(committed.length, 0);
  broom.leave();
  assert.equal(committed.length, 1);
  assert.deepEqual(state.items.all.map(({ uid }) => uid), ["at 400"]);
});

test("Esc lets all of it lie; a broom that has met nothing changes nothing", () => {
  const { state, committed, broom, hand } = sweeping();
  hand.hover([110, 110]);
  assert.equal(broom.cancel(), true);
  broom.leave();
  hand.hover([110, 300]);
  broom.leave();
  assert.deepEqual([committed.length, state.items.all.length], [0, 5]);
});
