import assert from "node:assert/strict";
import test from "node:test";

import { PolygonTool } from "../../../../static/editor/input/tools/polygon.js";
import { polygonOfCircle } from "../../../../static/editor/geometry/caps.js";
import { areaOf, shared } from "../../../../static/editor/geometry/regions.js";
import { handOf } from "../../support/hand.js";
import { capOf } from "../../support/caps.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

/** @type {Point[]} */
const FIVE = [
  [100, 100],
  [160, 100],
  [190, 150],
  [130, 200],
  [80, 150],
];

function drawing() {
  const { state, committed } = openState();
  const tool = new PolygonTool(state, () => {});
  const hand = handOf(state, tool);
  const rings = () => committed.flat().map(({ after }) => after.cap.visible[0]);
  return { state, tool, hand, rings };
}

/** A circle of 60 around (300, 300), a point every 6 degrees. @type {(degrees: number) => Point[]} */
function around(degrees) {
  return Array.from({ length: degrees / 6 + 1 }, (_, i) => (6 * i * Math.PI) / 180).map((angle) => {
    return [300 + 60 * Math.cos(angle), 300 + 60 * Math.sin(angle)];
  });
}

test("clicks place points, and Enter closes what they go around", () => {
  const { tool, hand, rings, state } = drawing();
  for (const point of FIVE) hand.click(point);
  tool.finish();
  assert.deepEqual(rings(), [FIVE.flat()]);
  assert.ok(state.halfDrawn.empty);
});

test("undo takes back the last point, redo places it again, and neither goes beyond the outline", () => {
  const { tool, hand, state } = drawing();
  for (const point of FIVE) hand.click(point);
  tool.undo();
  tool.undo();
  assert.deepEqual(state.halfDrawn.points, FIVE.slice(0, 3));
  assert.equal(tool.redo(), true);
  assert.deepEqual(state.halfDrawn.points, FIVE.slice(0, 4));
  tool.redo();
  assert.equal(tool.redo(), true);
  assert.deepEqual(state.halfDrawn.points, FIVE);
});

test("an undo that is held stops where the outline began; one some time later is for what was done before", async () => {
  const { tool, hand } = drawing();
  hand.click(FIVE[0]);
  assert.deepEqual([tool.undo(), tool.undo(), tool.undo()], [true, true, true]);
  await new Promise((resolve) => setTimeout(resolve, 650));
  assert.equal(tool.undo(), false);
});

test("the points of a stroke are taken back while it is being drawn, and it goes on from there", () => {
  const { tool, hand, state } = drawing();
  const way = around(120);
  hand.down(way[0]);
  hand.drag(...way.slice(1, 11));
  const count = state.halfDrawn.points.length;
  tool.undo();
  tool.undo();
  assert.equal(state.halfDrawn.points.length, count - 2);
  hand.drag(...way.slice(11));
  assert.ok(state.halfDrawn.points.length > count);
});

test("what Esc drops, undo brings back, unless something else was done meanwhile", () => {
  const { tool, hand, state } = drawing();
  for (const point of FIVE) hand.click(point);
  tool.cancel();
  assert.ok(state.halfDrawn.empty);
  tool.undo();
  assert.deepEqual(state.halfDrawn.points, FIVE);
  tool.cancel();
  hand.click([500, 500]);
  tool.undo();
  assert.ok(state.halfDrawn.empty);
});

test("taking up another tool leaves the points where they are", () => {
  const { tool, hand, state, rings } = drawing();
  for (const point of FIVE) hand.click(point);
  tool.leave();
  assert.deepEqual([state.halfDrawn.points, rings()], [FIVE, []]);
});

test("a hand that shakes, and the second press of a double click, place no second point", () => {
  for (const [dx, dy] of [
    [-1, -1],
    [3, 2],
    [0, 4],
    [5, 5],
    [-7, 2],
  ]) {
    const { hand, rings } = drawing();
    for (const point of FIVE) hand.click(point);
    const [x, y] = FIVE[4];
    hand.click([x + dx, y + dy]);
    hand.double([x + dx, y + dy]);
    assert.deepEqual(rings(), [FIVE.flat()], `${dx}, ${dy}`);
  }
});

test("points that were placed close together on purpose stay, also when the last is double-clicked", () => {
  const { hand, rings } = drawing();
  /** @type {Point[]} */
  const close = [...FIVE, [80, 143]];
  for (const point of close) hand.click(point);
  hand.click([81, 143]);
  hand.double([81, 143]);
  assert.deepEqual(rings(), [close.flat()]);
});

test("a stroke that ends near its start, or runs on beyond it, is closed when it is let go", () => {
  for (const degrees of [354, 360, 402, 540]) {
    const { hand, rings, state } = drawing();
    hand.stroke(around(degrees));
    assert.equal(rings().length, 1, `${degrees} degrees`);
    assert.ok(state.halfDrawn.empty);
  }
});

test("a stroke that stops half way stays half drawn, and clicks go on with it", () => {
  const { tool, hand, rings, state } = drawing();
  hand.stroke(around(240));
  const drawn = state.halfDrawn.points.length;
  assert.deepEqual([rings(), drawn > 20], [[], true]);
  hand.click([330, 260]);
  tool.finish();
  assert.equal(rings()[0].length, 2 * (drawn + 1));
});

test("two points are no outline: Enter leaves them, and Delete takes them back", () => {
  const { tool, hand, rings, state } = drawing();
  hand.click(FIVE[0]);
  hand.click(FIVE[1]);
  assert.deepEqual([tool.finish(), rings(), state.halfDrawn.points.length], [true, [], 2]);
  assert.deepEqual([tool.back(), tool.back(), tool.back()], [true, true, false]);
});

test("points beside the photo are placed on its border", () => {
  const { hand, state } = drawing();
  hand.click([-30, 20]);
  hand.click([2100, 1600]);
  assert.deepEqual(state.halfDrawn.points, [
    [0, 20],
    [2000, 1500],
  ]);
});

test("a freehand outline keeps the points that the eye tells apart, and stays within a pixel of what was drawn", () => {
  const { hand, rings } = drawing();
  const fine = Array.from({ length: 361 }, (_, i) => (i * Math.PI) / 180).map((angle) => {
    return /** @type {Point} */ ([300 + 60 * Math.cos(angle), 300 + 60 * Math.sin(angle)]);
  });
  hand.stroke(fine);
  const [ring] = rings();
  assert.ok(ring.length / 2 < 36, String(ring.length / 2));
  for (let i = 0; i < ring.length; i += 2) {
    const [x, y] = [ring[i] + ring[(i + 2) % ring.length], ring[i + 1] + ring[(i + 3) % ring.length]];
    assert.ok(Math.abs(Math.hypot(x / 2 - 300, y / 2 - 300) - 60) < 1.1);
  }
});

test("the part that is drawn of a cap, which stays selected meanwhile, becomes one of its parts; nothing is offered for it", () => {
  const shape = storedShape("u", capOf(FIVE.flat()));
  const { state, committed } = openState({ shapes: [shape] });
  const tool = new PolygonTool(state, () => {});
  const hand = handOf(state, tool);
  let offered = 0;
  state.signals.drawn.listen(() => void offered++);
  state.select(["u"]);
  tool.partOf = "u";
  for (const [x, y] of FIVE) hand.click([x + 200, y]);
  assert.equal(state.sole?.uid, "u");
  tool.finish();
  assert.deepEqual(committed.flat().map(({ after }) => [after.uid, after.cap.visible.length]), [["u", 2]]);
  assert.equal(offered, 0);
  for (const [x, y] of FIVE) hand.click([x + 400, y]);
  tool.finish();
  assert.equal(state.items.all.length, 2);
});

test("a new cap ends at the rim of the neighbour it overlaps, in a step of its own, and a bud upon another stays whole", () => {
  const neighbour = polygonOfCircle({ kind: "circle", cx: 390, cy: 300, r: 60 });
  const { state, committed } = openState({ shapes: [storedShape("next", capOf(neighbour))] });
  /** @type {string[]} */
  const said = [];
  const tool = new PolygonTool(state, (text) => void said.push(text));
  const hand = handOf(state, tool);
  hand.stroke(around(360));
  const [drawn, cut] = committed.map(([{ after }]) => after.cap.visible);
  assert.deepEqual([committed.length, said.length], [2, 1]);
  // Two circles of 60, 90 apart, share 2 r² acos(d / 2r) − d / 2 √(4r² − d²).
  const overlap = 2 * 60 ** 2 * Math.acos(0.75) - 45 * Math.sqrt(4 * 60 ** 2 - 90 ** 2);
  assert.ok(Math.abs(areaOf(drawn) - areaOf(cut) - overlap) < 60);
  assert.ok(areaOf(shared(cut, [neighbour])) < 2);
  assert.equal(state.items.get("next")?.cap.visible[0].length, neighbour.length);
  for (const [x, y] of FIVE) hand.click([390 + (x - 130) / 4, 300 + (y - 150) / 4]);
  tool.finish();
  assert.equal(committed.length, 3);
});
