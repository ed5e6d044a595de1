import assert from "node:assert/strict";
import test from "node:test";

import { areaOfRing, insideRing, newCap } from "../../../static/editor/geometry/caps.js";
import { redrawnCap, redrawnRing } from "../../../static/editor/geometry/rims.js";
import { simplified } from "../../../static/editor/geometry/strokes.js";
import { SQUARE, capOf } from "../support/caps.js";
import { pointsOf } from "../support/plane.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

const HOW = { reach: 5, tolerance: 0.3 };

/** An arc around (100, 100), a point every two degrees. @type {(radius: number, from: number, to: number) => Point[]} */
function arc(radius, from, to) {
  const step = from < to ? 2 : -2;
  return Array.from({ length: Math.abs(to - from) / 2 + 1 }, (_, i) => {
    const angle = ((from + step * i) * Math.PI) / 180;
    return [100 + radius * Math.cos(angle), 100 + radius * Math.sin(angle)];
  });
}

const CIRCLE = arc(50, 0, 358).flat();
const QUARTER = Math.PI / 4;

/** @type {(ring: number[], stroke: Point[], how?: Partial<typeof HOW & {other: boolean}>) => number} */
const area = (ring, stroke, how = {}) => areaOfRing(redrawnRing(ring, stroke, { ...HOW, ...how }) ?? []);

/** @type {(actual: number, expected: number, what?: string) => void} */
const about = (actual, expected, what) =>
  assert.ok(Math.abs(actual - expected) < 0.01 * expected, `${what ?? "area"}: ${actual}, not ${expected}`);

test("a stroke outside the rim adds what lies between, and one inside cuts it off, whichever way it runs", () => {
  const [whole, ring] = [4 * QUARTER * 2500, QUARTER];
  for (const [from, to] of [
    [0, 90],
    [90, 0],
    [300, 390],
  ]) {
    const outside = [...arc(50, from, from), ...arc(60, from, to), ...arc(50, to, to)];
    const inside = [...arc(50, from, from), ...arc(40, from, to), ...arc(50, to, to)];
    about(area(CIRCLE, outside), whole + ring * (3600 - 2500), `outside, ${from} to ${to}`);
    about(area(CIRCLE, inside), whole - ring * (2500 - 1600), `inside, ${from} to ${to}`);
  }
});

test("the rest of the outline keeps its vertices", () => {
  const made = redrawnRing(CIRCLE, [...arc(50, 0, 0), ...arc(60, 2, 88), ...arc(50, 90, 90)], HOW) ?? [];
  const kept = new Set(pointsOf(made).map(String));
  const rest = arc(50, 92, 358);
  assert.equal(rest.filter((point) => kept.has(String(point))).length, rest.length);
});

test("a stroke along most of the rim redraws most of it, though that is the longer way round", () => {
  const stroke = [...arc(50, 0, 0), ...arc(56, 0, 300), ...arc(50, 300, 300)];
  about(area(CIRCLE, stroke), Math.PI * ((3136 * 300 + 2500 * 60) / 360));
});

test("a stroke all the way round redraws all of it", () => {
  about(area(CIRCLE, arc(53, 0, 360)), Math.PI * 53 * 53);
});

test("a straight cut takes the smaller side away, and the larger one where that is asked for", () => {
  /** @type {Point[]} */
  const cut = Array.from({ length: 11 }, (_, i) => [30, 10 * i]);
  about(area(SQUARE, cut), 7000);
  about(area(SQUARE, cut, { other: true }), 3000);
});

test("a cut between two caps of one outline keeps the larger, though its rim is the shorter way round", () => {
  // A square of 60, and beside it a comb of the same height: far more rim, far less area.
  const comb = [60, 0, 100, 0, 100, 10, 80, 10, 80, 20, 100, 20, 100, 30, 80, 30, 80, 40, 100, 40, 100, 60, 60, 60];
  const both = [0, 0, ...comb, 0, 60];
  /** @type {Point[]} */
  const cut = Array.from({ length: 7 }, (_, i) => [60, 10 * i]);
  about(area(both, cut), 3600);
  about(area(both, cut.toReversed()), 3600);
});

test("a stroke that begins or ends off the rim counts from where it crosses it", () => {
  /** @type {Point[]} */
  const across = Array.from({ length: 15 }, (_, i) => [30, 10 * i - 20]);
  about(area(SQUARE, across), 7000);
});

test("both ends on one edge: the bump between them is added", () => {
  /** @type {Point[]} */
  const bump = [
    [20, 1],
    [20, -10],
    [60, -10],
    [60, 1],
  ];
  for (const stroke of [bump, bump.toReversed()]) about(area(SQUARE, stroke), 10000 + 40 * 10);
});

test("a stroke that keeps away from the rim changes nothing, nor does one with one end there", () => {
  assert.equal(redrawnRing(CIRCLE, arc(70, 0, 90), HOW), null);
  assert.equal(redrawnRing(CIRCLE, [...arc(50, 0, 0), ...arc(70, 0, 90)], HOW), null);
  assert.equal(redrawnRing(CIRCLE, arc(50, 0, 2), HOW), null, "a twitch");
});

test("of a cap in parts the one that the stroke meets is redrawn, the mark and the other parts stay", () => {
  const far = SQUARE.map((value) => value + 500);
  const cap = { ...capOf(far, CIRCLE), mark: { kind: /** @type {const} */ ("circle"), cx: 9, cy: 9, r: 5 } };
  const made = redrawnCap(cap, [...arc(50, 0, 0), ...arc(60, 2, 88), ...arc(50, 90, 90)], HOW);
  assert.ok(made);
  assert.deepEqual([made.visible[0], made.mark], [far, cap.mark]);
  assert.ok(insideRing(made.visible[1], 100 + 55 * Math.SQRT1_2, 100 + 55 * Math.SQRT1_2));
});

test("where nothing is visible the polygon mark is redrawn", () => {
  const cap = newCap({ mark: { kind: "polygon", points: SQUARE } });
  const made = redrawnCap(
    cap,
    Array.from({ length: 11 }, (_, i) => [30, 10 * i]),
    HOW,
  );
  assert.ok(made?.mark?.kind === "polygon");
  about(areaOfRing(made.mark.points), 7000);
});

test("of a dense stroke as many points are kept as the eye tells apart", () => {
  const dense = Array.from({ length: 500 }, (_, i) => /** @type {Point} */ ([i / 5, 0]));
  assert.deepEqual(simplified(dense, 0.5), [dense[0], dense[499]]);
  const round = simplified(arc(50, 0, 358), 0.5);
  assert.ok(round.length < 40, String(round.length));
  about(areaOfRing(round.flat()), Math.PI * 2500);
});
