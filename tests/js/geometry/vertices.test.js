import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import {
  draggedVertices,
  insertedVertices,
  nearestEdges,
  nearestVertices,
  removedVertices,
  spacedVertices,
} from "../../../static/editor/geometry/vertices.js";
import { SQUARE, capOf } from "../support/caps.js";

/** A straight row of vertices, one pixel apart. @type {(count: number) => number[]} */
const row = (count) => Array.from({ length: count }, (_, x) => [x, 0]).flat();

test("the nearest vertex is found within reach only", () => {
  const cap = capOf([0, 0, 10, 0, 10, 10, 0, 10]);
  assert.deepEqual(nearestVertices(cap, [9, 1], 3), [{ ring: 0, index: 1 }]);
  assert.deepEqual(nearestVertices(cap, [5, 5], 3), []);
});

test("dragging a vertex of a sparse outline moves it alone", () => {
  const moved = draggedVertices(capOf(SQUARE), [{ ring: 0, index: 1 }], { dx: 5, dy: -3, pull: 16 });
  assert.deepEqual(moved.visible, [[0, 0, 105, -3, 100, 100, 0, 100]]);
});

test("a dense outline follows the vertex that is dragged, less the farther away it is", () => {
  const cap = capOf([...row(40), 20, 200]);
  const [moved] = draggedVertices(cap, [{ ring: 0, index: 20 }], { dx: 0, dy: 8, pull: 10 }).visible;
  for (let x = 0; x < 40; x++) {
    const along = Math.abs(x - 20);
    const expected = along < 10 ? 8 * Math.cos((Math.PI * along) / 20) ** 2 : 0;
    assert.equal(moved[2 * x], x);
    assert.ok(Math.abs(moved[2 * x + 1] - expected) < 1e-9);
  }
});

test("a mark taken from the outline moves with it", () => {
  const cap = newCap({ visible: [SQUARE], mark: { kind: "polygon", points: SQUARE } });
  const found = nearestVertices(cap, [101, 1], 5);
  assert.deepEqual(found, [
    { ring: 0, index: 1 },
    { ring: 1, index: 1 },
  ]);
  const { visible, mark } = draggedVertices(cap, found, { dx: 1, dy: 2, pull: 0 });
  const expected = [0, 0, 101, 2, 100, 100, 0, 100];
  assert.deepEqual([visible, mark], [[expected], { kind: "polygon", points: expected }]);
});

test("a press on an edge puts a vertex there", () => {
  const cap = capOf(SQUARE);
  const edge = nearestEdges(cap, [102, 40], 6);
  assert.ok(edge);
  const inserted = insertedVertices(cap, edge.edges, edge.foot);
  assert.deepEqual(inserted.vertices, [{ ring: 0, index: 2 }]);
  assert.deepEqual(inserted.cap.visible, [[0, 0, 100, 0, 100, 40, 100, 100, 0, 100]]);
});

test("the edge that closes the outline is an edge too", () => {
  const cap = capOf(SQUARE);
  const edge = nearestEdges(cap, [-1, 50], 6);
  assert.ok(edge);
  assert.deepEqual(insertedVertices(cap, edge.edges, edge.foot).cap.visible, [[...SQUARE, 0, 50]]);
});

test("an outline never falls below three vertices", () => {
  const once = removedVertices(capOf(SQUARE), [{ ring: 0, index: 0 }]);
  assert.ok(once);
  assert.deepEqual(once.visible, [[100, 0, 100, 100, 0, 100]]);
  assert.equal(removedVertices(once, [{ ring: 0, index: 0 }]), null);
});

test("changing a cap leaves the one it came from alone", () => {
  const cap = capOf(SQUARE);
  const before = structuredClone(cap);
  const second = [{ ring: 0, index: 1 }];
  draggedVertices(cap, second, { dx: 5, dy: 5, pull: 300 });
  removedVertices(cap, second);
  insertedVertices(cap, second, [1, 1]);
  assert.deepEqual(cap, before);
});

test("handles keep their distance along the outline", () => {
  assert.deepEqual(spacedVertices(row(101), 10), [0, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100]);
});
