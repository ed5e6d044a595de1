import assert from "node:assert/strict";
import test from "node:test";

import { Pace, atLeast, checkAndGoOn, openOnes, progressOf } from "../../../static/editor/state/walking.js";
import { goToOpen } from "../../../static/editor/input/actions/walking.js";
import { shapeOfAnnotation } from "../../../static/editor/geometry/shapes.js";
import { capOf, prediction, triangle } from "../support/caps.js";
import { openState } from "../support/state.js";

/** What a file said, with a centre known within so many pixels. @type {(uid: string, sd: number) => any} */
function imported(uid, sd) {
  const whole = { kind: /** @type {const} */ ("circle"), cx: 0, cy: 0, r: 50 };
  const fields = { image: 1, revision: 1, deleted: false, centre: null, extra: {}, whole };
  return shapeOfAnnotation({ uid, cap: capOf(triangle(300)), ...fields, centre_sd: [sd, sd] }, false);
}

/** @type {(scores: number[]) => any[]} */
const said = (scores) => scores.map((score, i) => ({ ...prediction(i + 1, [triangle(20 * i)]), score }));

test("Space says that the selected one is right and goes on to the worst that is open, until none is", () => {
  const { state, committed } = openState({ predictions: said([0.9, 0.4, 0.7]) });
  const met = [];
  while (checkAndGoOn(state)) met.push(state.sole?.score);
  assert.deepEqual(met, [0.4, 0.7, 0.9]);
  assert.equal(committed.length, 3);
  assert.ok(state.items.all.every(({ checked, score }) => checked && score === null));
  assert.deepEqual([...state.selection.uids], []);
});

test("where the quality of outlines is known, the worst is the one whose outline is least likely to be good", () => {
  const scored = said([0.9, 0.4, 0.7]);
  const qualities = [0.6, 0.95, 0.8];
  const { state } = openState({ predictions: scored.map((one, i) => ({ ...one, quality: qualities[i] })) });
  const met = [];
  while (checkAndGoOn(state)) met.push(state.sole?.score);
  assert.deepEqual(met, [0.9, 0.7, 0.4]);
});

test("a cap of a file is open until somebody says that it is right, which is an edit that changes nothing", () => {
  const { state, committed } = openState({ shapes: [imported("sure", 0.5), imported("unsure", 4)] });
  checkAndGoOn(state);
  assert.equal(state.sole?.uid, "unsure");
  checkAndGoOn(state);
  assert.equal(state.sole?.uid, "sure");
  const [[{ before, after }]] = committed;
  assert.deepEqual([before?.uid, after.cap === before?.cap, after.checked], ["unsure", true, true]);
});

test("a cap that was changed is checked by that, one that is ignored is never open", () => {
  const { state } = openState({ shapes: [imported("u", 1)] });
  const shape = state.items.all[0];
  state.propose([{ ...shape, cap: { ...shape.cap, doubtful: true } }]);
  state.commitDrafts();
  assert.deepEqual(openOnes(state.items.all), []);
  assert.deepEqual(openOnes([{ ...shape, cap: { ...shape.cap, ignored: true } }]), []);
});

test("the next open cap is the next as one reads, the first again after the last, and nothing is decided", () => {
  const { state, committed } = openState({ predictions: said([0.9, 0.4, 0.7]), shapes: [imported("u", 1)] });
  /** @type {any} */
  const context = { state, say: (/** @type {string} */ text) => assert.equal(text, "") };
  const met = [];
  for (let i = 0; i < 5; i++) {
    goToOpen(context);
    met.push(state.sole?.score);
  }
  assert.deepEqual(met, [0.9, 0.4, 0.7, null, 0.9]);
  assert.deepEqual(committed, []);
});

test("a threshold means the predictions that are shown and have at least that score", () => {
  const { state } = openState({ predictions: said([0.9, 0.4, 0.7]), shapes: [imported("u", 1)] });
  assert.deepEqual([0, 0.7, 0.95].map((score) => atLeast(state, score).length), [3, 2, 0]);
  state.layers.visible = { ...state.layers.visible, prediction: false };
  assert.deepEqual(atLeast(state, 0), []);
});

test("the line says how many are done and how long the rest takes", () => {
  const { state } = openState({ predictions: said([0.9, 0.4]), shapes: [imported("u", 1)] });
  checkAndGoOn(state);
  checkAndGoOn(state);
  assert.equal(progressOf(state.items.all, 150000), "1 of 3, about 3 min");
  assert.equal(progressOf(state.items.all, 9000), "1 of 3, under a minute");
  assert.equal(progressOf([], 0), "no caps");
  assert.equal(progressOf(state.items.all.filter(({ checked }) => checked), 0), "all 1 checked");
});

test("the pace is that of the latest caps, and neither pauses nor many at once tell of it", () => {
  const pace = new Pace();
  pace.start(100, 0);
  pace.count(99, 2000);
  pace.count(98, 6000);
  pace.count(97, 8000);
  assert.equal(pace.expect(10), 20000);
  pace.count(96, 8000 + 10 * 60000);
  pace.count(20, 8000 + 10 * 60000 + 1);
  assert.equal(pace.expect(10), 20000);
});
