import assert from "node:assert/strict";
import test from "node:test";

import { questionOf } from "../../../static/editor/state/finishing.js";

const NOTHING = { name: "bed.png", open: 0, caps: 20, unchecked: 0, coarse: 0 };

test("the question says how many predictions are open, how many caps there are, and what that means", () => {
  assert.equal(
    questionOf("annotated", { ...NOTHING, open: 272, caps: 0 })?.text,
    "bed.png has 272 predictions that are neither accepted nor turned down, and no annotation. " +
      "Set to “annotated” as it is, it counts as a photo without a single cap.",
  );
  assert.equal(
    questionOf("approved", { ...NOTHING, open: 1 })?.text,
    "bed.png has one prediction that is neither accepted nor turned down, and 20 annotations. " +
      "Set to “approved” as it is, what it shows counts as no cap.",
  );
});

test("what is open may be turned down at once, where anything is", () => {
  assert.equal(questionOf("annotated", { ...NOTHING, open: 272 })?.down, "Turn the 272 down first");
  assert.equal(questionOf("annotated", { ...NOTHING, open: 1 })?.down, "Turn it down first");
  assert.equal(questionOf("annotated", { ...NOTHING, coarse: 1 })?.down, null);
});

test("where every cap is checked nothing is asked", () => {
  assert.equal(questionOf("annotated", NOTHING), null);
});

test("a photo without any cap has to be said to be empty", () => {
  const question = questionOf("annotated", { ...NOTHING, caps: 0 });
  assert.match(question?.text ?? "", /no cap at all/);
  assert.equal(question?.yes, "It is empty");
});

test("caps that nobody has checked and outlines of few points are counted in one question", () => {
  assert.equal(
    questionOf("annotated", { ...NOTHING, unchecked: 3, coarse: 1 })?.text,
    "bed.png has 3 imported caps that nobody has checked, and one outline of fewer points than 10, 20 or 25 " +
      "(small, medium, large). Set to “annotated” as it is, they stay as they are.",
  );
});
