import assert from "node:assert/strict";
import test from "node:test";

import { newCap, polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { isMarkOf, shareInside } from "../../../static/editor/geometry/marks.js";
import { newShape } from "../../../static/editor/geometry/shapes.js";
import { SQUARE, shapeOf } from "../support/caps.js";

/** @type {(cx: number, cy: number, r: number) => import("../../../static/editor/protocol.js").Circle} */
const circle = (cx, cy, r) => ({ kind: "circle", cx, cy, r });

/** What is seen of a circle of 50 around (50, 50) whose right part, from `x` on, lies under a neighbour. */
/** @type {(x: number) => number[]} */
function crescent(x) {
  const ring = polygonOfCircle(circle(50, 50, 50));
  return ring.map((value, i) => (i % 2 === 0 ? Math.min(value, x) : value));
}

test("the share of an outline inside a circle is that of its area, whatever its parts", () => {
  assert.ok(Math.abs(shareInside([SQUARE], circle(0, 0, 100)) - Math.PI / 4) < 0.01);
  const small = [200, 0, 210, 0, 210, 10, 200, 10];
  assert.ok(Math.abs(shareInside([SQUARE, small], circle(50, 50, 90)) - 1 / 1.01) < 0.001);
});

test("a circle around what is seen is the cap's mark, also where its centre is hidden", () => {
  const hidden = shapeOf("u", crescent(30));
  assert.ok(isMarkOf(circle(50, 50, 50), hidden));
  assert.ok(isMarkOf(circle(54, 47, 45), hidden));
});

test("nor does it take the whole of what is seen, where it is begun well inside the whole outline", () => {
  const hidden = shapeOf("u", crescent(30));
  const known = { ...hidden, whole: circle(51, 49, 51) };
  assert.deepEqual(
    [hidden, known].map((shape) => isMarkOf(circle(50, 50, 32), shape)),
    [false, true],
  );
  assert.equal(isMarkOf(circle(95, 50, 32), known), false, "the neighbour that hides it");
  assert.equal(isMarkOf(circle(60, 50, 12), known), false, "a bud upon it");
});

test("a circle from within the outline is its mark, also a small one, but not one of a speck on it", () => {
  const cap = shapeOf("u", polygonOfCircle(circle(50, 50, 50)));
  assert.ok(isMarkOf(circle(50, 50, 30), cap));
  assert.equal(isMarkOf(circle(60, 50, 8), cap), false);
});

test("a circle over a bud beside the cap is another cap", () => {
  const cap = shapeOf("u", polygonOfCircle(circle(50, 50, 50)));
  assert.equal(isMarkOf(circle(112, 50, 14), cap), false);
  assert.equal(isMarkOf(circle(101, 50, 9), cap), false);
});

test("a circle around a large cap is not the mark of a bud that it happens to cover", () => {
  const bud = shapeOf("u", polygonOfCircle(circle(112, 50, 8)));
  assert.equal(isMarkOf(circle(80, 50, 60), bud), false);
});

test("of a cap that is a circle only, a circle like it is the better one, and one beside it another cap", () => {
  const last = newShape("u", newCap({ mark: circle(50, 50, 20) }));
  assert.ok(isMarkOf(circle(53, 48, 22), last));
  assert.equal(isMarkOf(circle(72, 50, 8), last), false);
  assert.equal(isMarkOf(circle(65, 50, 18), last), false);
  assert.equal(isMarkOf(circle(50, 50, 8), last), false);
});

test("a cap that shows nothing and is no circle has no mark by a circle", () => {
  assert.equal(isMarkOf(circle(50, 50, 20), newShape("u", newCap())), false);
});
