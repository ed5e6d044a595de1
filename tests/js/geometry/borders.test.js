import assert from "node:assert/strict";
import test from "node:test";

import { leftOf, snapped } from "../../../static/editor/geometry/borders.js";
import { areaOf } from "../../../static/editor/geometry/regions.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/** Its left border runs down x = 100, with a vertex at y = 50. */
const NEIGHBOUR = [100, 0, 200, 0, 200, 100, 100, 100, 100, 50];

test("a line along a neighbour's rim becomes that rim, vertices and all; its ends stay", () => {
  /** @type {Point[]} */
  const line = [
    [60, 20],
    [97, 20],
    [98, 40],
    [96, 80],
    [60, 80],
  ];
  assert.deepEqual(snapped(line, [NEIGHBOUR], 5), [
    [60, 20],
    [100, 20],
    [100, 40],
    [100, 50],
    [100, 80],
    [60, 80],
  ]);
});

test("a line beyond reach of any rim stays as it was drawn", () => {
  /** @type {Point[]} */
  const line = [
    [60, 20],
    [90, 40],
    [60, 80],
  ];
  assert.deepEqual(snapped(line, [NEIGHBOUR], 5), line);
  assert.deepEqual(snapped(line, [], 5), line);
});

test("between two places far apart on a rim a line takes no detour along it", () => {
  /** @type {Point[]} */
  const line = [
    [150, -20],
    [150, -2],
    [150, 102],
    [150, 120],
  ];
  assert.deepEqual(
    snapped(line, [NEIGHBOUR], 5).map(([x]) => x),
    [150, 150, 150, 150],
  );
});

test("a neighbour loses what another gains of it, but neither nothing nor all", () => {
  const left = leftOf([NEIGHBOUR], [[50, 0, 120, 0, 120, 100, 50, 100]]);
  assert.equal(left && areaOf(left), 8000);
  assert.equal(leftOf([NEIGHBOUR], [[0, 0, 90, 0, 90, 100, 0, 100]]), null);
  assert.equal(leftOf([NEIGHBOUR], [[50, -50, 300, -50, 300, 200, 50, 200]]), null);
});

test("a crumb that is parted from a neighbour goes, a larger piece and a part that was there before stay", () => {
  // NEIGHBOUR is 100 × 100 px from (100, 0); a strip is taken out of it, right of which a piece is left.
  const upTo = (/** @type {number} */ x) => [[150, -10, x, -10, x, 110, 150, 110]];
  assert.equal(areaOf(leftOf([NEIGHBOUR], upTo(199.7)) ?? []), 5000);
  assert.equal(areaOf(leftOf([NEIGHBOUR], upTo(190)) ?? []), 6000);
  const speck = [300, 0, 305, 0, 305, 5, 300, 5];
  assert.equal(areaOf(leftOf([NEIGHBOUR, speck], upTo(210)) ?? []), 5025);
});
