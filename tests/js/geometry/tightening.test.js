import assert from "node:assert/strict";
import test from "node:test";

import { polygonOfCircle } from "../../../static/editor/geometry/caps.js";
import { pointsOf } from "../../../static/editor/geometry/places.js";
import { drawnAlong, reachAround, tightened } from "../../../static/editor/geometry/tightening.js";

/** @typedef {import("../../../static/editor/geometry/tightening.js").Patch} Patch */

/** @type {(cx: number, cy: number, r: number) => import("../../../static/editor/protocol.js").Circle} */
const circle = (cx, cy, r) => ({ kind: "circle", cx, cy, r });

/** A photo of 200 × 200 at (100, 100), bright where `inside` says so. @type {(inside: (x: number, y: number) => boolean) => Patch} */
function photo(inside) {
  const values = Float32Array.from({ length: 200 * 200 }, (_, i) => {
    const [x, y] = [100 + (i % 200) + 0.5, 100 + Math.floor(i / 200) + 0.5];
    const spots = 8 * Math.sin(1.7 * x) * Math.cos(2.3 * y);
    return (inside(x, y) ? 190 : 60) + spots;
  });
  return { values, width: 200, height: 200, x0: 100, y0: 100, step: 1 };
}

const DISC = photo((x, y) => Math.hypot(x - 200, y - 200) < 40);

/** How far the points of a ring stray from a circle, at most. @type {(ring: number[], r: number) => number} */
const strays = (ring, r) => Math.max(...pointsOf(ring).map(([x, y]) => Math.abs(Math.hypot(x - 200, y - 200) - r)));

test("a loose circle beside the rim is drawn to the rim", () => {
  for (const loose of [circle(203, 198, 44), circle(196, 201, 36), circle(200, 200, 40)])
    assert.ok(strays(tightened(polygonOfCircle(loose), DISC), 40) < 1.2);
});

test("so is a rough loop of few points", () => {
  const rough = [165, 180, 200, 157, 240, 175, 243, 215, 205, 243, 160, 225];
  assert.ok(strays(tightened(rough, DISC), 40) < 1.5);
});

test("where nothing shows an edge, the rim is where the network sees it", () => {
  const dark = photo(() => false);
  const seen = polygonOfCircle(circle(201, 200, 40));
  const ring = tightened(polygonOfCircle(circle(204, 197, 44)), dark, seen);
  for (const [x, y] of pointsOf(ring)) assert.ok(Math.abs(Math.hypot(x - 201, y - 200) - 40) < 1.2);
});

test("where a neighbour lies in front, the outline follows the border between the two", () => {
  const cut = photo((x, y) => Math.hypot(x - 200, y - 200) < 40 && x < 215);
  const loose = polygonOfCircle(circle(198, 200, 38)).map((value, i) => (i % 2 ? value : Math.min(value, 221)));
  const ring = tightened(loose, cut);
  const border = pointsOf(ring).filter(([x, y]) => x > 200 && Math.abs(y - 200) < 32);
  assert.ok(border.length > 0);
  for (const [x] of border) assert.ok(Math.abs(x - 215) < 1.5, String(x));
});

test("a circle or ellipse is drawn along by the points that lie near to it, and by no others", () => {
  const rim = pointsOf(polygonOfCircle(circle(200, 200, 40)));
  const drawn = drawnAlong(circle(203, 198, 44), [...rim, [200, 200], [260, 260]]);
  assert.ok(drawn.kind === "circle");
  assert.ok(Math.hypot(drawn.cx - 200, drawn.cy - 200) < 0.01 && Math.abs(drawn.r - 40) < 0.01);
  const half = rim.filter(([x]) => x < 200);
  const ellipse = drawnAlong({ kind: "ellipse", cx: 201, cy: 199, a: 43, b: 38, theta_deg: 20 }, half);
  assert.ok(ellipse.kind === "ellipse");
  assert.ok(Math.abs(ellipse.a - 40) < 0.5 && Math.abs(ellipse.b - 40) < 0.5);
});

test("it stays as it is where too few points tell of it, or they tell of something else", () => {
  const placed = circle(200, 200, 40);
  assert.equal(drawnAlong(placed, pointsOf(polygonOfCircle(circle(200, 200, 60)))), placed);
  assert.equal(drawnAlong(placed, pointsOf(polygonOfCircle(circle(200, 200, 41))).slice(0, 4)), placed);
});

test("thin fingers of a rough outline are not followed", () => {
  const fingers = pointsOf(polygonOfCircle(circle(200, 200, 40))).flatMap(([x, y], i) => {
    const far = i % 9 === 4 ? 1.25 : 1;
    return [200 + far * (x - 200), 200 + far * (y - 200)];
  });
  assert.ok(strays(tightened(fingers, DISC), 40) < 1.5);
});

test("enough of the photo is asked for", () => {
  assert.ok(reachAround(polygonOfCircle(circle(0, 0, 40))) > 12);
});
