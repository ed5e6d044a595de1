import assert from "node:assert/strict";
import test from "node:test";

import { centred, closeUp, revealing, toImage, viewOf, zoomed } from "../../../static/editor/geometry/view.js";
import { chances } from "../support/chances.js";

const SIZE = { width: 1016, height: 850 };
const AT_HOME = { scale: 1, x: 0, y: 0 };

/** @type {(found: number, expected: number, within?: number) => void} */
function assertClose(found, expected, within = 1e-6) {
  assert.ok(Math.abs(found - expected) <= within, `${found} is not ${expected}`);
}

test("zooming keeps the point under the pointer, and ends at 64 screen pixels a pixel", () => {
  const { between } = chances(1);
  for (let i = 0; i < 100; i++) {
    const view = { scale: between(0.1, 20), x: between(-900, 900), y: between(-900, 900) };
    const [x, y, factor] = [between(0, 1000), between(0, 800), between(0.3, 5)];
    const after = zoomed(view, { x, y, factor, smallest: 0.01 });
    const [before, now] = [toImage(view, x, y), toImage(after, x, y)];
    assertClose(now[0], before[0]);
    assertClose(now[1], before[1]);
    assertClose(after.scale, Math.min(view.scale * factor, 64));
  }
});

test("zooming stops at the smallest scale without drifting", () => {
  const view = { scale: 0.5, x: 10, y: 20 };
  assert.deepEqual(zoomed(view, { x: 300, y: 200, factor: 0.1, smallest: 0.5 }), view);
});

test("showing all centres the photo inside the margin", () => {
  const { scale, x, y } = viewOf({ x0: 0, y0: 0, x1: 1280, y1: 720 }, SIZE, 12);
  assertClose(scale, (1016 - 24) / 1280);
  assertClose(x, 12);
  assertClose(y, (850 - 720 * scale) / 2);
});

for (const [where, bounds, x, y] of /** @type {const} */ ([
  ["on screen", { x0: 400, y0: 300, x1: 500, y1: 400 }, 0, 0],
  ["off to the left", { x0: -50, y0: 300, x1: 50, y1: 400 }, 90, 0],
  ["off to the lower right", { x0: 950, y0: 800, x1: 1050, y1: 900 }, 1016 - 40 - 1050, 850 - 40 - 900],
])) {
  test(`revealing what is ${where} moves no farther than it must`, () => {
    assert.deepEqual(revealing(AT_HOME, bounds, SIZE), { scale: 1, x, y });
  });
}

/** @type {(view: import("../../../static/editor/geometry/view.js").View) => number[]} */
const inTheMiddle = (view) => toImage(view, SIZE.width / 2, SIZE.height / 2);

test("revealing makes a cap that is too small to work on just large enough, in the middle", () => {
  const view = revealing({ scale: 2, x: 0, y: 0 }, { x0: 100, y0: 100, x1: 106, y1: 104 }, SIZE);
  assert.deepEqual([view.scale, inTheMiddle(view)], [8, [103, 102]]);
});

test("no step towards a cap zooms in more than six times, however small the cap; the next goes on", () => {
  const tiny = { x0: 100, y0: 100, x1: 102, y1: 102 };
  const first = closeUp(AT_HOME, tiny, SIZE);
  assert.deepEqual([first.scale, inTheMiddle(first)], [6, [101, 101]]);
  assert.equal(closeUp(first, tiny, SIZE).scale, 36);
  assert.equal(revealing({ scale: 0.25, x: 0, y: 0 }, tiny, SIZE).scale, 1.5);
});

test("a close-up of a large cap fills the window, and zooms out as far as that takes", () => {
  const large = { x0: 0, y0: 0, x1: 400, y1: 400 };
  const { scale } = closeUp({ scale: 30, x: 0, y: 0 }, large, SIZE);
  assert.equal(scale, (SIZE.height - 80) / 800);
});

test("what lies at the edge of the window is brought to its middle, what lies about there stays", () => {
  const edge = centred(AT_HOME, { x0: 990, y0: 800, x1: 1010, y1: 820 }, SIZE);
  assert.deepEqual(edge, { scale: 1, x: -492, y: -385 });
  assert.deepEqual(centred(AT_HOME, { x0: 490, y0: 300, x1: 510, y1: 320 }, SIZE), AT_HOME);
});
