import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import { pick, within } from "../../../static/editor/geometry/hit.js";
import { newShape } from "../../../static/editor/geometry/shapes.js";
import { nearestEdges } from "../../../static/editor/geometry/vertices.js";
import { capOf, shapeOf, star } from "../support/caps.js";
import { chances } from "../support/chances.js";
import { areaByTriangles, distanceBySteps, isAround } from "../support/plane.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

test("the smallest cap around the pointer is picked, as winding and triangles say", () => {
  const random = chances(3);
  const place = () => ({ x: random.between(0, 300), y: random.between(0, 300) });
  const rings = Array.from({ length: 60 }, () =>
    star(random, { ...place(), radius: random.between(8, 80), count: 17 }),
  );
  const shapes = rings.map((ring, i) => shapeOf(String(i), ring));
  let hits = 0;
  for (let i = 0; i < 200; i++) {
    /** @type {Point} */
    const point = [random.between(0, 300), random.between(0, 300)];
    const around = rings.filter((ring) => isAround(ring, point));
    around.sort((a, b) => areaByTriangles(a) - areaByTriangles(b));
    const expected = around.length ? String(rings.indexOf(around[0])) : null;
    assert.equal(pick(shapes, point, 0)?.uid ?? null, expected);
    hits += around.length ? 1 : 0;
  }
  assert.ok(hits > 50);
});

test("a labelled cap is picked rather than its prediction, but a nested prediction is reached", () => {
  const labelled = shapeOf("labelled", [0, 0, 40, 0, 40, 40, 0, 40]);
  const again = { ...shapeOf("again", [1, 1, 39, 1, 39, 39, 1, 39]), score: 0.9 };
  const nested = { ...shapeOf("nested", [10, 10, 20, 10, 20, 20, 10, 20]), score: 0.9 };
  const all = [labelled, again, nested];
  assert.equal(pick(all, [30, 30], 3)?.uid, "labelled");
  assert.equal(pick(all, [15, 15], 3)?.uid, "nested");
});

test("beside every cap the nearest outline within reach is picked", () => {
  const all = [
    shapeOf("left", [0, 0, 10, 0, 10, 10, 0, 10]),
    shapeOf("right", [20, 0, 30, 0, 30, 10, 20, 10]),
  ];
  assert.equal(pick(all, [14, 5], 6)?.uid, "left");
  assert.equal(pick(all, [16, 5], 6)?.uid, "right");
  assert.equal(pick(all, [15, 40], 6), null);
});

test("the rim of a bare circle can be picked from outside", () => {
  const circle = newShape("circle", newCap({ mark: { kind: "circle", cx: 50, cy: 50, r: 20 } }));
  const found = [
    [50, 50],
    [72, 50],
    [74, 50],
    [50, 28.5],
  ].map(([x, y]) => pick([circle], [x, y], 3)?.uid ?? null);
  assert.deepEqual(found, ["circle", "circle", null, "circle"]);
});

test("a rubber band holds only what lies wholly inside", () => {
  const all = [shapeOf("in", [10, 10, 20, 10, 15, 20]), shapeOf("across", [10, 10, 40, 10, 15, 20])];
  const found = within(all, { x0: 5, y0: 5, x1: 30, y1: 30 });
  assert.deepEqual(
    found.map(({ uid }) => uid),
    ["in"],
  );
});

test("the nearest edge is as far away as the nearest of many points on the outline", () => {
  const random = chances(5);
  const ring = star(random, { x: 60, y: 60, radius: 50, count: 23 });
  for (let i = 0; i < 100; i++) {
    /** @type {Point} */
    const point = [random.between(0, 120), random.between(0, 120)];
    const edge = nearestEdges(capOf(ring), point, 1e9);
    assert.ok(edge);
    const found = Math.hypot(edge.foot[0] - point[0], edge.foot[1] - point[1]);
    assert.ok(Math.abs(found - distanceBySteps(ring, point)) < 0.02);
  }
});
