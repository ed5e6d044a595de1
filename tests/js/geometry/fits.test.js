import assert from "node:assert/strict";
import test from "node:test";

import { circleBy, ellipseBy } from "../../../static/editor/geometry/fits.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/** @type {(t: number, how: {a: number, b: number, degrees: number}) => Point} */
function onEllipse(t, { a, b, degrees }) {
  const angle = (degrees * Math.PI) / 180;
  const [u, v] = [a * Math.cos(t), b * Math.sin(t)];
  return [300 + u * Math.cos(angle) - v * Math.sin(angle), 200 + u * Math.sin(angle) + v * Math.cos(angle)];
}

test("three points tell a circle, points on a line none", () => {
  const circle = circleBy([
    [310, 200],
    [300, 210],
    [290, 200],
  ]);
  assert.deepEqual(
    circle && [circle.cx, circle.cy, circle.r].map((value) => Math.round(value * 1e6) / 1e6),
    [300, 200, 10],
  );
  assert.equal(
    circleBy([
      [0, 0],
      [1, 1],
      [2, 2],
    ]),
    null,
  );
});

test("five points of an ellipse tell it, turned as it may be and seen from one side", () => {
  for (const degrees of [10, 45, 89, 120, 170]) {
    for (const span of [2 * Math.PI, 3]) {
      const points = [0, 1, 2, 3, 4].map((i) => onEllipse((span * i) / 5, { a: 50, b: 40, degrees }));
      const ellipse = ellipseBy(points);
      assert.ok(ellipse);
      const { cx, cy, a, b, theta_deg } = ellipse;
      for (const [found, meant] of [[cx, 300], [cy, 200], [a, 50], [b, 40], [theta_deg, degrees]])
        assert.ok(Math.abs(found - meant) < 1e-6, `${found} for ${meant}`);
    }
  }
});

test("four points, or points along a line, tell no ellipse", () => {
  const four = [0, 1, 2, 3].map((t) => onEllipse(t, { a: 50, b: 40, degrees: 0 }));
  assert.equal(ellipseBy(four), null);
  assert.equal(ellipseBy([0, 1, 2, 3, 4, 5].map((x) => [x, 2 * x])), null);
});
