import assert from "node:assert/strict";
import test from "node:test";

import { polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { crowdOf, paint } from "../../../static/editor/render/paint.js";
import { Layers } from "../../../static/editor/state/layers.js";
import { capOf } from "../support/caps.js";
import { storedShape } from "../support/state.js";

const PHOTO = { width: 2000, height: 1000 };
const WINDOW = { width: 1000, height: 800 };

test("a window that shows the whole photo holds all of its caps", () => {
  assert.equal(crowdOf(600, PHOTO, WINDOW, 0.5), 600);
  assert.equal(crowdOf(600, PHOTO, WINDOW, 0.1), 600);
});

test("a window that shows a part of it holds as large a part of its caps", () => {
  // Half of the width and all of the height but a fifth; then a quarter of the width and 40 % of the height.
  assert.equal(crowdOf(600, PHOTO, WINDOW, 1), 600 * 0.5 * 0.8);
  assert.equal(crowdOf(600, PHOTO, WINDOW, 2), 600 * 0.25 * 0.4);
});

/** What is drawn of a cap so many CSS pixels wide, how opaque: its whole outline and its centre, or its label. @type {(width: number, drawn?: "stroke" | "fillText") => number[]} */
function seenOf(width, drawn = "stroke") {
  const scale = 0.1;
  const radius = width / 2 / scale;
  const whole = { kind: /** @type {const} */ ("circle"), cx: 500, cy: 500, r: radius };
  const shape = { ...storedShape("u", capOf(polygonOfCircle(whole))), whole, centre: /** @type {[number, number]} */ ([500, 500]) };
  /** @type {number[]} */
  const alphas = [];
  /** @type {{globalAlpha: number}} */
  const context = new Proxy(
    { globalAlpha: 1, [drawn]: () => void alphas.push(context.globalAlpha) },
    { get: (own, name) => Reflect.get(own, name) ?? (() => {}) },
  );
  const visible = { ...new Layers().visible, fill: false, outline: false, label: drawn === "fillText" };
  const region = { x0: 0, y0: 0, x1: 1000, y1: 1000 };
  paint(/** @type {any} */ (context), { scale, x: 0, y: 0 }, region, { shapes: [shape], visible, selected: new Set(), crowd: 1 });
  return [...new Set(alphas)];
}

test("whole outlines and centres are not drawn of caps that are small on screen, faintly of larger ones, and come as one zooms in", () => {
  assert.deepEqual([seenOf(14), seenOf(80)], [[], [1]]);
  const between = seenOf(30);
  assert.equal(between.length, 2);
  assert.ok(between[0] < between[1] && between[1] < 1, String(between));
});

test("labels, too, come as one zooms in: from 24 pixels on, and all of them at 40", () => {
  assert.deepEqual([20, 32, 48].map((width) => seenOf(width, "fillText")), [[], [0.5], [1]]);
});
