import assert from "node:assert/strict";
import test from "node:test";

import { questionOf } from "../../../static/editor/state/finishing.js";

test("the question says how many predictions are open, how many caps there are, and what that means", () => {
  assert.equal(
    questionOf("annotated", { name: "bed.png", open: 272, caps: 0 }).text,
    "bed.png has 272 predictions that are neither accepted nor turned down, and no annotation. " +
      "Set to “annotated” as it is, it counts as a photo without a single cap.",
  );
  assert.equal(
    questionOf("approved", { name: "bed.png", open: 1, caps: 20 }).text,
    "bed.png has one prediction that is neither accepted nor turned down, and 20 annotations. " +
      "Set to “approved” as it is, what it shows counts as no cap.",
  );
});
