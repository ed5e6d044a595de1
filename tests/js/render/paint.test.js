import assert from "node:assert/strict";
import test from "node:test";

import { crowdOf } from "../../../static/editor/render/paint.js";

const PHOTO = { width: 2000, height: 1000 };
const WINDOW = { width: 1000, height: 800 };

test("a window that shows the whole photo holds all of its caps", () => {
  assert.equal(crowdOf(600, PHOTO, WINDOW, 0.5), 600);
  assert.equal(crowdOf(600, PHOTO, WINDOW, 0.1), 600);
});

test("a window that shows a part of it holds as large a part of its caps", () => {
  // Half of the width and all of the height but a fifth; then a quarter of the width and 40 % of the height.
  assert.equal(crowdOf(600, PHOTO, WINDOW, 1), 600 * 0.5 * 0.8);
  assert.equal(crowdOf(600, PHOTO, WINDOW, 2), 600 * 0.25 * 0.4);
});
