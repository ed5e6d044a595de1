import assert from "node:assert/strict";
import test from "node:test";

import { Clipboard } from "../../../static/editor/state/clipboard.js";
import { shapeOfPrediction } from "../../../static/editor/geometry/shapes.js";
import { newCap } from "../../../static/editor/geometry/caps.js";
import { prediction, shapeOf } from "../support/caps.js";

const BOX = [100, 100, 140, 100, 140, 160, 100, 160];
/** @type {(changes: import("../../../static/editor/state/changes.js").Change[]) => number[][]} */
const rings = (changes) => changes.map(({ after }) => after.cap.visible[0]);

test("on its own photo a copy lies with its middle at the pointer, on another at its own place", () => {
  const clipboard = new Clipboard();
  clipboard.copy([shapeOf("u", BOX)], 1);
  assert.deepEqual(rings(clipboard.paste(1, [320, 230])), [[300, 200, 340, 200, 340, 260, 300, 260]]);
  assert.deepEqual(rings(clipboard.paste(2, [320, 230])), [BOX]);
});

test("a copy is a cap of its own: new, with its mark moved along, and without a link to a prediction", () => {
  const clipboard = new Clipboard();
  const cap = newCap({ visible: [BOX], mark: { kind: "circle", cx: 120, cy: 130, r: 30 }, prediction: 4, doubtful: true });
  clipboard.copy([{ ...shapeOf("u", BOX), cap }], 1);
  const [{ before, after }] = clipboard.paste(1, [130, 130]);
  assert.equal(before, null);
  assert.notEqual(after.uid, "u");
  const mark = { kind: "circle", cx: 130, cy: 130, r: 30 };
  assert.deepEqual([after.cap.prediction, after.cap.doubtful, after.cap.mark, after.revision], [null, false, mark, 0]);
});

test("the caps of the photo that was shown before come along, its open predictions do not", () => {
  const clipboard = new Clipboard();
  assert.deepEqual(clipboard.pasteBefore(2), []);
  clipboard.leave([shapeOf("u", BOX), shapeOfPrediction(prediction(1))], 1);
  assert.deepEqual(rings(clipboard.pasteBefore(2)), [BOX]);
  assert.deepEqual(clipboard.pasteBefore(1), []);
});
