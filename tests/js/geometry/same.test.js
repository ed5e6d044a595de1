import assert from "node:assert/strict";
import test from "node:test";

import { same } from "../../../static/editor/geometry/same.js";
import { SQUARE, capOf } from "../support/caps.js";

test("two caps are the same whatever the order of their fields, also within the mark", () => {
  const cap = { ...capOf(SQUARE), mark: { kind: "circle", cx: 1, cy: 2, r: 3 } };
  const other = Object.fromEntries(Object.entries(cap).reverse());
  other.mark = { r: 3, cy: 2, cx: 1, kind: "circle" };
  assert.notEqual(JSON.stringify(cap), JSON.stringify(other));
  assert.ok(same(cap, other));
});

const different = [
  ["a number", { a: 1 }, { a: 2 }],
  ["a number and its text", { a: 1 }, { a: "1" }],
  ["null and nothing", { a: null }, {}],
  ["nothing and null", {}, { a: null }],
  ["another field", { a: 1 }, { b: 1 }],
  ["the order of a list", [1, 2], [2, 1]],
  ["the length of a list", [1, 2], [1, 2, 3]],
  ["a list and an object", [], {}],
  ["an object and null", {}, null],
  ["false and null", false, null],
  ["one vertex deep inside", { visible: [[0, 0, 1, 0, 1, 1]] }, { visible: [[0, 0, 1, 0, 1, 2]] }],
];

for (const [what, a, b] of different) {
  test(`values differ by ${what}`, () => assert.ok(!same(a, b)));
}
