import assert from "node:assert/strict";
import test from "node:test";

import { inverse } from "../../../static/editor/state/changes.js";
import { decideOn, takePrediction } from "../../../static/editor/state/deciding.js";
import { Review } from "../../../static/editor/state/review.js";
import { Standing, lookAt } from "../../../static/editor/state/standing.js";
import { deleteSelected, nudge } from "../../../static/editor/state/edits.js";
import { capOf, prediction, triangle } from "../support/caps.js";
import { openState, storedShape } from "../support/state.js";

/** @typedef {import("../../../static/editor/protocol.js").ComparedCap} ComparedCap */
/** @typedef {import("../../../static/editor/geometry/shapes.js").Shape} Shape */

const NETWORKS = [0, 100, 200].map(triangle);
const ELSEWHERE = triangle(700);

/** A cap that started from a prediction. @type {(uid: string, id: number, how?: {at?: number[], deleted?: boolean}) => Shape} */
function heir(uid, id, { at = NETWORKS[id - 1], deleted = false } = {}) {
  return { ...storedShape(uid, { ...capOf(at), prediction: id }), deleted };
}

/** Three predictions: one accepted, one accepted and moved far away, one turned down. */
function reviewed() {
  const predictions = NETWORKS.map((visible, nth) => prediction(nth + 1, [visible]));
  const shapes = [heir("kept", 1), heir("moved", 2, { at: ELSEWHERE }), heir("gone", 3, { deleted: true })];
  const { state, committed } = openState({ shapes, predictions });
  const alone = { iou: null, cdr: null, floor: null };
  /** @type {ComparedCap[]} */
  const caps = [
    { annotation: "moved", prediction: null, ...alone },
    { annotation: null, prediction: predictions[1], ...alone },
    { annotation: null, prediction: predictions[2], ...alone },
    { annotation: "kept", prediction: predictions[0], iou: 1, cdr: null, floor: null },
  ];
  const review = new Review();
  review.changed.listen(() => state.showBesides(review.extra(1)));
  review.on = true;
  review.take(1, caps);
  return { state, committed, review, caps };
}

/** What is selected, going on until it comes round. @type {(found: ReturnType<typeof reviewed>) => string[]} */
function walk({ state, review }) {
  /** @type {string[]} */
  const seen = [];
  for (let next = new Standing(state, review).next(1); next && !seen.includes(next); next = new Standing(state, review).next(1)) {
    lookAt(state, next);
    seen.push(state.selection.soleUid ?? "nothing");
  }
  return seen;
}

/** @type {(found: ReturnType<typeof reviewed>, cap: ComparedCap) => void} */
function takeModels({ state, review }, cap) {
  decideOn(state, review, cap, () => takePrediction(state, review, cap));
}

test("the walk comes to every cap that counts as missed or extra, also to predictions that were decided upon", () => {
  const found = reviewed();
  assert.deepEqual(walk(found), ["moved", "prediction:2", "prediction:3"]);
  found.state.layers.toggle("prediction");
  assert.deepEqual(walk(found).at(-1), "prediction:3");
});

test("a press picks a prediction that was turned down while a reviewer looks, and not otherwise", () => {
  const { state, review } = reviewed();
  assert.equal(state.at([202, 2], 0)?.uid, "prediction:3");
  assert.ok(!state.items.all.some(({ uid }) => uid === "prediction:3"));
  state.select(["prediction:3"]);
  review.on = false;
  assert.equal(state.at([202, 2], 0), null);
  assert.equal(state.selection.uids.size, 0);
});

test("the model's in place of nothing brings the cap back that was deleted, under its own number", () => {
  const found = reviewed();
  found.state.select(["prediction:3"]);
  takeModels(found, found.caps[2]);
  const back = found.state.store.get("gone");
  assert.deepEqual([back?.deleted, back?.cap.visible, back?.cap.prediction], [false, [NETWORKS[2]], 3]);
  assert.equal(found.state.selection.soleUid, "gone");
  found.state.store.apply(inverse(found.committed[0]));
  assert.equal(found.state.store.get("gone")?.deleted, true);
});

test("the model's of a cap that was moved too far is the prediction that it started from", () => {
  for (const nth of [0, 1]) {
    const found = reviewed();
    takeModels(found, found.caps[nth]);
    const moved = found.state.store.get("moved");
    assert.deepEqual([moved?.deleted, moved?.cap.visible], [false, [NETWORKS[1]]]);
    const { left, done } = new Standing(found.state, found.review);
    assert.deepEqual([left, done], [["prediction:3"], 2]);
  }
});

test("of a second annotator the mark is taken with the outline, of a model never", () => {
  const round = /** @type {const} */ ({ kind: "circle", cx: 5, cy: 5, r: 9 });
  for (const second of ["ben.json", null]) {
    const found = reviewed();
    const [said] = [prediction(4, [NETWORKS[0]])];
    const theirs = { ...said, whole: round, extra: { marked: true } };
    const both = { annotation: "kept", prediction: theirs, iou: 0.9, cdr: null, floor: null };
    found.review.take(1, [both], second);
    takeModels(found, both);
    assert.deepEqual(found.state.store.get("kept")?.cap.mark, second ? round : null);
    const extra = { ...both, annotation: null, prediction: { ...theirs, id: 5 } };
    found.review.take(1, [extra], second);
    lookAt(found.state, "prediction:5");
    takeModels(found, extra);
    const drawn = found.state.store.all().find(({ cap }) => cap.prediction === 5);
    assert.deepEqual(drawn?.cap.mark, second ? round : null);
  }
});

test("the model's of a cap that no network saw is no cap", () => {
  const found = reviewed();
  found.state.store.apply([{ before: null, after: storedShape("drawn", capOf(triangle(900))) }]);
  const drawn = { annotation: "drawn", prediction: null, iou: null, cdr: null, floor: null };
  found.review.take(1, [drawn, ...found.caps]);
  takeModels(found, drawn);
  assert.equal(found.state.store.get("drawn")?.deleted, true);
});

test("what is decided is left out of the walk and counted, until it is undone", () => {
  const found = reviewed();
  const standing = () => {
    const { left, done, total } = new Standing(found.state, found.review);
    return [left.length, done, total];
  };
  assert.deepEqual(standing(), [3, 0, 3]);
  takeModels(found, found.caps[2]);
  assert.deepEqual(standing(), [2, 1, 3]);
  assert.equal(new Standing(found.state, found.review).after("prediction:3"), "moved");
  found.state.store.apply(inverse(found.committed[0]));
  assert.deepEqual(standing(), [3, 0, 3]);
});

test("a prediction that was turned down is not turned down twice, and one that is a cap elsewhere makes another", () => {
  const { state, committed } = reviewed();
  state.select(["prediction:3"]);
  deleteSelected(state);
  assert.deepEqual(committed, []);
  state.select(["prediction:2"]);
  nudge(state, 1, 0);
  state.commitDrafts();
  const [{ before, after }] = committed[0];
  assert.deepEqual([before, after.cap.prediction], [null, null]);
  assert.deepEqual(state.store.get("moved")?.cap.visible, [ELSEWHERE]);
});
