import assert from "node:assert/strict";
import test from "node:test";

import { countWords } from "../../../static/editor/ui/review_strip.js";

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
