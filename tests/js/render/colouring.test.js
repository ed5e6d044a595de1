import assert from "node:assert/strict";
import test from "node:test";

import { shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { RAMP, goodness, lineOf } from "../../../static/editor/render/colouring.js";
import { SQUARE, capOf, prediction } from "../support/caps.js";
import { storedShape } from "../support/state.js";

const CIRCLE = { kind: /** @type {const} */ ("circle"), cx: 50, cy: 50, r: 50 };

test("open predictions are coloured by score, and by the quality that their outline is likely to have", () => {
  const shape = shapeOfPrediction({ ...prediction(1), score: 0.65, quality: 0.9 });
  assert.ok(Math.abs((goodness(shape, "score") ?? 0) - 0.5) < 1e-9);
  assert.ok(Math.abs((goodness(shape, "quality") ?? 0) - 0.8) < 1e-9);
  assert.equal(goodness(shapeOfPrediction({ ...prediction(1), quality: 0.2 }), "quality"), 0);
});

test("a cap that people agreed on has neither; how sure its centre is counts in widths", () => {
  const cap = { ...storedShape("u", capOf(SQUARE)), whole: CIRCLE, sd: /** @type {[number, number]} */ ([1, 2.5]) };
  assert.deepEqual([goodness(cap, "score"), goodness(cap, "quality")], [null, null]);
  assert.ok(Math.abs((goodness(cap, "sure") ?? 0) - 0.5) < 1e-9);
});

test("what is bad differs from what is good by the width of its line as well as by its colour", () => {
  const [bad, good] = [lineOf(0), lineOf(1)];
  assert.deepEqual([bad.colour, good.colour], [RAMP[0], RAMP[RAMP.length - 1]]);
  assert.ok(bad.width > 2 * good.width);
});
