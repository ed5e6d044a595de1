import assert from "node:assert/strict";
import test from "node:test";

import { boundsOfWhole, measure, newCap, polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { SQUARE, capOf } from "../support/caps.js";
import { pointsOf } from "../support/plane.js";

for (const r of [3, 40, 900]) {
  test(`a circle of ${r} px as polygon keeps its centre and errs by a tenth of a pixel at most`, () => {
    const points = pointsOf(polygonOfCircle({ kind: "circle", cx: 123.25, cy: 77.5, r }));
    const mean = [0, 1].map((axis) => points.reduce((sum, point) => sum + point[axis], 0) / points.length);
    assert.ok(Math.hypot(mean[0] - 123.25, mean[1] - 77.5) < 1e-9);
    for (const [i, [x, y]] of points.entries()) {
      const [nextX, nextY] = points[(i + 1) % points.length];
      const middle = Math.hypot((x + nextX) / 2 - 123.25, (y + nextY) / 2 - 77.5);
      assert.ok(Math.abs(Math.hypot(x - 123.25, y - 77.5) - r) < 1e-6);
      assert.ok(r - middle <= 0.1);
    }
  });
}

test("the bounds of an ellipse are those of its points", () => {
  const turn = (33 * Math.PI) / 180;
  const points = Array.from({ length: 20_000 }, (_, i) => (2 * Math.PI * i) / 20_000).map((t) => [
    10 + 40 * Math.cos(t) * Math.cos(turn) - 15 * Math.sin(t) * Math.sin(turn),
    20 + 40 * Math.cos(t) * Math.sin(turn) + 15 * Math.sin(t) * Math.cos(turn),
  ]);
  const { x0, y0, x1, y1 } = boundsOfWhole({ kind: "ellipse", cx: 10, cy: 20, a: 40, b: 15, theta_deg: 33 });
  const xs = points.map(([x]) => x);
  const ys = points.map(([, y]) => y);
  const expected = [Math.min(...xs), Math.min(...ys), Math.max(...xs), Math.max(...ys)];
  for (const [i, found] of [x0, y0, x1, y1].entries()) assert.ok(Math.abs(found - expected[i]) < 1e-5);
});

test("the bounds of a cap hold its outline and its mark, its area is that of what is visible", () => {
  const cap = newCap({ visible: [SQUARE], mark: { kind: "circle", cx: 100, cy: 50, r: 60 } });
  assert.deepEqual(measure(cap), { bounds: { x0: 0, y0: -10, x1: 160, y1: 110 }, area: 10_000 });
  assert.deepEqual(measure(capOf()), { bounds: null, area: 0 });
});
