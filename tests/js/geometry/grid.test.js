import assert from "node:assert/strict";
import test from "node:test";

import { overlap } from "../../../static/editor/geometry/bounds.js";
import { Grid } from "../../../static/editor/geometry/grid.js";
import { chances } from "../support/chances.js";

/** @typedef {import("../../../static/editor/geometry/bounds.js").Bounds} Bounds */

/** Also beside the image, tiny, and larger than it. @type {(chance: ReturnType<typeof chances>) => Bounds} */
function rectangle({ chance, between }) {
  const [x0, y0] = [between(-300, 2200), between(-300, 1700)];
  const size = [0, 5, 60, 400, 5000][chance(5)];
  return { x0, y0, x1: x0 + between(0, size), y1: y0 + between(0, size) };
}

for (let seed = 0; seed < 8; seed++) {
  test(`the grid finds what a look at every rectangle finds (${seed})`, () => {
    const random = chances(seed);
    const grid = new Grid();
    /** @type {Map<string, Bounds>} */
    const all = new Map();
    for (let step = 0; step < 400; step++) {
      const name = String(random.chance(150));
      const bounds = rectangle(random);
      if (random.chance(4)) {
        grid.put(name, bounds);
        all.set(name, bounds);
      } else {
        grid.remove(name);
        all.delete(name);
      }
      const where = rectangle(random);
      const expected = [...all].filter(([, found]) => overlap(found, where)).map(([found]) => found);
      assert.deepEqual(grid.near(where).sort(), expected.sort());
    }
  });
}

test("a rectangle on the line between two cells is found from both sides", () => {
  const grid = new Grid();
  grid.put("a", { x0: 64, y0: 64, x1: 64, y1: 64 });
  assert.deepEqual(grid.near({ x0: 60, y0: 60, x1: 64, y1: 64 }), ["a"]);
  assert.deepEqual(grid.near({ x0: 64, y0: 64, x1: 70, y1: 70 }), ["a"]);
  assert.deepEqual(grid.near({ x0: 65, y0: 64, x1: 70, y1: 70 }), []);
});

test("a rectangle without end is found like any other", () => {
  const grid = new Grid();
  grid.put("endless", { x0: 0, y0: -Infinity, x1: Infinity, y1: Infinity });
  for (let i = 0; i < 300; i++) grid.put(`beside ${i}`, { x0: -9, y0: -9, x1: -8, y1: -8 });
  assert.deepEqual(grid.near({ x0: 5, y0: 5, x1: 6, y1: 6 }), ["endless"]);
});
