import assert from "node:assert/strict";
import test from "node:test";

import { polygonOfCircle } from "../../../../static/editor/geometry/caps.js";
import { RimPointsTool } from "../../../../static/editor/input/tools/rim_points.js";
import { capOf } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

/** Of an ellipse of 60 × 40 around (500, 400). @type {(turn: number) => Point} */
const rim = (turn) => [500 + 60 * Math.cos(2 * Math.PI * turn), 400 + 40 * Math.sin(2 * Math.PI * turn)];
const FIVE = [0.02, 0.2, 0.43, 0.61, 0.83].map(rim);
/** @type {Point[]} */
const THREE = [
  [540, 400],
  [500, 440],
  [460, 400],
];

/** @type {(shapes?: import("../../../../static/editor/geometry/shapes.js").Shape[]) => any} */
function pointing(shapes = []) {
  const { state, committed } = openState({ shapes });
  const tool = new RimPointsTool(state);
  const made = () => committed.flat().map(({ after }) => after);
  return { state, tool, hand: handOf(state, tool), made };
}

test("three points of a rim make a cap with a circle as its mark and what is seen of it, by Enter", () => {
  const { tool, hand, made } = pointing();
  for (const at of THREE) hand.click(at);
  assert.deepEqual(made(), []);
  tool.finish();
  const [{ cap }] = made();
  assert.deepEqual(cap.mark, { kind: "circle", cx: 500, cy: 400, r: 40 });
  assert.equal(cap.visible.length, 1);
});

test("five make an ellipse; undo takes back the last point", () => {
  const { tool, hand, made } = pointing();
  for (const at of [...FIVE, [900, 900]]) hand.click(at);
  assert.equal(tool.undo(), true);
  tool.finish();
  const [{ cap }] = made();
  assert.deepEqual([cap.mark.kind, Math.round(cap.mark.a), Math.round(cap.mark.b)], ["ellipse", 60, 40]);
});

test("points of the rim of a selected half-hidden cap mark that cap", () => {
  const seen = polygonOfCircle({ kind: "circle", cx: 500, cy: 400, r: 40 }).map((v, i) => (i % 2 ? v : Math.min(v, 470)));
  const whole = { kind: "circle", cx: 500, cy: 400, r: 36 };
  const { state, tool, hand, made } = pointing([/** @type {any} */ ({ ...storedShape("u", capOf(seen)), whole })]);
  state.select(["u"]);
  for (const at of THREE) hand.click(at);
  tool.finish();
  assert.deepEqual(made().map((/** @type {any} */ { uid, cap }) => [uid, cap.mark.r]), [["u", 40]]);
});

test("two points are none yet; another tool that is taken up puts down what three tell", () => {
  const { tool, hand, made } = pointing();
  for (const at of THREE.slice(0, 2)) hand.click(at);
  tool.finish();
  assert.deepEqual(made(), []);
  hand.click(THREE[2]);
  tool.leave();
  assert.equal(made().length, 1);
  assert.equal(tool.undo(), false);
});
