import assert from "node:assert/strict";
import test from "node:test";

import { Review } from "../../../static/editor/state/review.js";
import { countWords, kindWords } from "../../../static/editor/ui/review_strip.js";
import { openState } from "../support/state.js";

/** @type {(at: number, done: number, left: number) => string} */
function words(at, done, left) {
  return countWords({ at, done, left: Array(left).fill("cap"), total: done + left });
}

test("the strip says which of all differences is selected, and how many are left where none is", () => {
  assert.equal(words(-1, 0, 0), "No differences");
  assert.equal(words(-1, 0, 1), "1 difference");
  assert.equal(words(0, 0, 12), "1 of 12 differences");
  assert.equal(words(1, 2, 10), "4 of 12 differences");
  assert.equal(words(-1, 2, 10), "10 of 12 differences left");
  assert.equal(words(-1, 12, 0), "All 12 differences decided");
});

test("whoever has no such cap is the model, or the second annotator by name where theirs is compared", () => {
  const { state } = openState({});
  const review = new Review();
  const missed = { annotation: "drawn", prediction: null, iou: null, cdr: null, floor: null };
  review.take(1, [missed]);
  assert.equal(kindWords(state, review, missed), "missed: the model has no such cap");
  review.take(1, [missed], "ben.json");
  assert.equal(kindWords(state, review, missed), "missed: ben.json has no such cap");
});
