import assert from "node:assert/strict";
import test from "node:test";

import { areaOfRing, polygonOfCircle } from "../../../../static/editor/geometry/caps.js";
import { areaOf, shared } from "../../../../static/editor/geometry/regions.js";
import { rimTool } from "../../../../static/editor/input/tools/rim.js";
import { FADED } from "../../../../static/editor/render/palette.js";
import { SelectTool } from "../../../../static/editor/input/tools/select.js";
import { capOf, prediction } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/protocol.js").Point} Point */

const ROUND = polygonOfCircle({ kind: "circle", cx: 300, cy: 300, r: 80 });
const BESIDE = polygonOfCircle({ kind: "circle", cx: 600, cy: 300, r: 80 });

/** An arc around (300, 300), with its ends on the rim of the cap there. @type {(radius: number) => Point[]} */
function overQuarter(radius) {
  const at = (/** @type {number} */ degrees, /** @type {number} */ r) => {
    const angle = (degrees * Math.PI) / 180;
    return /** @type {Point} */ ([300 + r * Math.cos(angle), 300 + r * Math.sin(angle)]);
  };
  const way = Array.from({ length: 31 }, (_, i) => at(3 * i, radius));
  return [at(0, 80), ...way, at(90, 80)];
}

const ADDED = (Math.PI / 4) * (100 ** 2 - 80 ** 2);

/** @type {(visible: number[][]) => number} */
const area = (visible) => visible.reduce((sum, ring) => sum + areaOfRing(ring), 0);

/**
 * The colours of the lines and the words that a tool paints.
 *
 * @type {(tool: import("../../../../static/editor/input/tools/tool.js").Tool, state: import("../../../../static/editor/state/editor_state.js").EditorState) => {strokes: string[], words: string[]}}
 */
function paintedBy(tool, state) {
  /** @type {string[]} */
  const strokes = [];
  /** @type {string[]} */
  const words = [];
  /** @type {{strokeStyle: string, stroke: () => void, fillText: (text: string) => void}} */
  const context = new Proxy(
    {
      strokeStyle: "",
      stroke: () => void strokes.push(context.strokeStyle),
      fillText: (/** @type {string} */ text) => void words.push(text),
    },
    { get: (own, name) => Reflect.get(own, name) ?? (() => {}) },
  );
  tool.sketch?.(/** @type {any} */ (context), state.viewport.view);
  return { strokes, words };
}

function redrawing() {
  const { state, committed } = openState({
    shapes: [storedShape("round", capOf(ROUND)), storedShape("beside", capOf(BESIDE))],
    predictions: [prediction(7, [ROUND.map((value, i) => (i % 2 ? value + 500 : value))])],
  });
  /** @type {string[]} */
  const said = [];
  const say = (/** @type {string} */ text) => void said.push(text);
  const tool = rimTool(state, say);
  const made = () => committed.flat().map(({ after }) => after);
  return { state, committed, said, say, tool, hand: handOf(state, tool), made };
}

test("a stroke outside the rim adds to the cap whose rim it begins on, in one step, and selects it", () => {
  const { state, committed, hand, made } = redrawing();
  hand.stroke(overQuarter(100));
  const [after] = made();
  assert.deepEqual([committed.length, after.uid, [...state.selection.uids]], [1, "round", ["round"]]);
  assert.ok(Math.abs(area(after.cap.visible) - area([ROUND]) - ADDED) < 60);
});

test("a selected cap is meant before others, but not where the stroke is far from it", () => {
  const { state, hand, made } = redrawing();
  state.select(["beside"]);
  hand.stroke(overQuarter(100));
  assert.deepEqual(
    made().map(({ uid }) => uid),
    ["round"],
  );
});

test("a prediction that is redrawn becomes an annotation that started from it", () => {
  const { state, hand, made } = redrawing();
  hand.stroke(overQuarter(100).map(([x, y]) => /** @type {Point} */ ([x, y + 500])));
  const [after] = made();
  assert.deepEqual([after.cap.prediction, after.score, [...state.selection.uids]], [7, null, [after.uid]]);
});

test("a stroke that meets no rim changes nothing and says what a stroke does", () => {
  const { hand, made, said } = redrawing();
  hand.stroke(overQuarter(100).map(([x, y]) => /** @type {Point} */ ([x + 150, y + 150])));
  assert.deepEqual([made(), said.length], [[], 1]);
});

test("a stroke that begins beside a cap and runs through it cuts it, though it is not selected", () => {
  const { hand, made } = redrawing();
  hand.stroke(Array.from({ length: 26 }, (_, i) => /** @type {Point} */ ([260, 180 + 10 * i])));
  const [after] = made();
  const angle = Math.acos(0.5);
  const segment = 80 ** 2 * (angle - Math.sin(angle) / 2);
  assert.ok(Math.abs(area(after.cap.visible) - (area([ROUND]) - segment)) < 40);
});

test("a click selects the cap that is there", () => {
  const { state, hand, made } = redrawing();
  hand.click([600, 300]);
  assert.deepEqual([[...state.selection.uids], made()], [["beside"], []]);
});

test("undo while a stroke is drawn is about the stroke; another tool ends it as letting go does", () => {
  const { tool, hand, made } = redrawing();
  const [first, ...way] = overQuarter(100);
  hand.down(first);
  hand.drag(...way.slice(0, 10));
  assert.equal(tool.undo(), true);
  hand.drag(...way.slice(10));
  hand.up(way[way.length - 1]);
  assert.deepEqual([made(), tool.undo()], [[], false]);
  hand.down(first);
  hand.drag(...way);
  tool.leave();
  assert.equal(made().length, 1);
});

test("Ctrl and a drag do the same with the tool in hand that selects", () => {
  const { state, say, tool, made } = redrawing();
  const hand = handOf(state, new SelectTool(state, { say, rim: tool }));
  hand.stroke(overQuarter(100), { ctrl: true });
  const [after] = made();
  assert.ok(Math.abs(area(after.cap.visible) - area([ROUND]) - ADDED) < 60);
});

test("the new rim has as many points as the eye tells apart, not as many as the hand made", () => {
  const { hand, made } = redrawing();
  const way = overQuarter(100).flatMap((at, i, all) => {
    const next = all[Math.min(i + 1, all.length - 1)];
    return [at, /** @type {Point} */ ([(at[0] + next[0]) / 2, (at[1] + next[1]) / 2])];
  });
  hand.stroke(way);
  assert.ok(made()[0].cap.visible[0].length / 2 < (3 / 4) * (ROUND.length / 2) + 16);
});

/** Beside the round one, 20 px away; what of it a stroke takes is counted in its own area. */
const NEXT = polygonOfCircle({ kind: "circle", cx: 480, cy: 300, r: 80 });

function besideANeighbour() {
  const { state, committed } = openState({ shapes: [storedShape("round", capOf(ROUND)), storedShape("next", capOf(NEXT))] });
  const hand = handOf(state, rimTool(state, () => {}));
  const now = (/** @type {string} */ uid) => state.items.get(uid)?.cap.visible ?? [];
  return { state, committed, hand, now };
}

/** From the rim of the round one out to x and back. @type {(x: number) => Point[]} */
function bulge(x) {
  const at = (/** @type {number} */ degrees) => (degrees * Math.PI) / 180;
  const [top, bottom] = [at(-40), at(40)].map((a) => /** @type {Point} */ ([300 + 80 * Math.cos(a), 300 + 80 * Math.sin(a)]));
  return [top, [x, top[1]], [x, 280], [x, 300], [x, 320], [x, bottom[1]], bottom];
}

test("what a stroke adds beyond a neighbour's rim the neighbour loses, in the same step", () => {
  const { committed, hand, now } = besideANeighbour();
  hand.stroke(bulge(430));
  assert.equal(committed.length, 1);
  assert.deepEqual(committed[0].map(({ after }) => after.uid), ["round", "next"]);
  assert.ok(area(now("next")) < area([NEXT]) - 500);
  assert.ok(areaOf(shared(now("round"), now("next"))) < 2);
});

test("an open prediction that would keep but a shred stays one; of another the rest becomes a cap", () => {
  const within = [385, 285, 420, 285, 420, 315, 385, 315];
  const { state, committed } = openState({
    shapes: [storedShape("round", capOf(ROUND))],
    predictions: [prediction(7, [within]), prediction(8, [NEXT])],
  });
  handOf(state, rimTool(state, () => {})).stroke(bulge(415));
  assert.deepEqual(
    committed[0].map(({ after }) => after.cap.prediction),
    [null, 8],
  );
});

test("a stroke along a neighbour's rim takes nothing of it and leaves no gap", () => {
  const { committed, hand, now } = besideANeighbour();
  const rim = Array.from({ length: 9 }, (_, i) => {
    const angle = Math.PI - 0.4 + 0.1 * i;
    return /** @type {Point} */ ([480 + 83 * Math.cos(angle), 300 - 83 * Math.sin(angle)]);
  });
  const [first, ...rest] = bulge(400);
  hand.stroke([first, ...rim.toReversed(), rest[rest.length - 1]].sort((a, b) => a[1] - b[1]));
  assert.deepEqual(committed[0].map(({ after }) => after.uid), ["round"]);
  const strip = [[398, 270, 412, 270, 412, 330, 398, 330]];
  const both = areaOf(shared(strip, now("round"))) + areaOf(shared(strip, now("next")));
  assert.ok(Math.abs(areaOf(strip) - both) < 2, String(both));
});

test("the cap is shown that a stroke will change, also where the pointer is beside it, and with Ctrl while selecting", () => {
  const { state, tool, say, hand } = redrawing();
  hand.hover([398, 300]);
  assert.equal(state.selection.hovered, "round");
  hand.hover([450, 300]);
  assert.equal(state.selection.hovered, null);
  hand.hover([502, 300]);
  assert.equal(state.selection.hovered, "beside");
  const select = handOf(state, new SelectTool(state, { say, rim: tool }));
  select.hover([398, 300]);
  assert.equal(state.selection.hovered, null);
  select.hover([398, 300], { ctrl: true });
  assert.equal(state.selection.hovered, "round");
});

test("a stroke that begins and ends beside the rim reaches it: at the nearest place, or where it makes straight for it", () => {
  const beside = redrawing();
  const [, ...way] = overQuarter(100).slice(0, -1);
  beside.hand.stroke([...way]);
  // At either end the line goes from the rim to the second point of the stroke: less by a sliver of 52 px².
  assert.ok(Math.abs(area(beside.made()[0].cap.visible) - area([ROUND]) - ADDED) < 150);
  const through = redrawing();
  through.hand.stroke(Array.from({ length: 20 }, (_, i) => /** @type {Point} */ ([260, 212 + 9.5 * i])));
  const angle = Math.acos(0.5);
  const segment = 80 ** 2 * (angle - Math.sin(angle) / 2);
  assert.ok(Math.abs(area(through.made()[0].cap.visible) - (area([ROUND]) - segment)) < 40);
});

/** A cap that was found too small, by a quarter of its true radius of 108, and six around it that touch its true rim. */
function denseSpot() {
  const around = Array.from({ length: 6 }, (_, i) => {
    const angle = (i * Math.PI) / 3;
    const [cx, cy] = [600 + 216 * Math.cos(angle), 500 + 216 * Math.sin(angle)];
    return storedShape(`around ${i}`, capOf(polygonOfCircle({ kind: "circle", cx, cy, r: 108 })));
  });
  const small = storedShape("small", capOf(polygonOfCircle({ kind: "circle", cx: 600, cy: 500, r: 80 })));
  const { state, committed } = openState({ shapes: [small, ...around] });
  const tool = rimTool(state, () => {});
  return { state, tool, hand: handOf(state, tool), meant: () => committed.map(([{ after }]) => after.uid) };
}

/** Around (600, 500). @type {(radius: number, from: number, to: number) => Point[]} */
function arcOfSpot(radius, from, to) {
  return Array.from({ length: Math.floor((to - from) / 2) + 1 }, (_, i) => {
    const angle = ((from + 2 * i) * Math.PI) / 180;
    return [600 + radius * Math.cos(angle), 500 + radius * Math.sin(angle)];
  });
}

test("a stroke along the true rim of a cap, a third of its radius off, is about that cap, though neighbours touch it there", () => {
  for (const [from, to] of [
    [-60, 60],
    [20, 100],
    [-30, 30],
    [0, 300],
  ]) {
    for (const zoom of [0.5, 1, 6]) {
      const { hand, meant, state } = denseSpot();
      state.viewport.zoomBy(zoom);
      hand.stroke(arcOfSpot(108, from, to));
      assert.deepEqual(meant(), ["small"], `${from} to ${to}, ${zoom} times as large`);
    }
  }
});

test("a stroke that bends around a neighbour is about the neighbour, unless another cap is selected", () => {
  // Along the rim of the one to the right, 4 px inside the gap.
  const along = /** @type {Point[]} */ (
    Array.from({ length: 9 }, (_, i) => (Math.PI * (170 + 2.5 * i)) / 180).map((angle) => {
      return [816 + 112 * Math.cos(angle), 500 + 112 * Math.sin(angle)];
    })
  );
  const { hand, meant, state } = denseSpot();
  hand.stroke(along);
  state.select(["small"]);
  hand.stroke(along);
  assert.deepEqual(meant(), ["around 0", "small"]);
});

test("while a stroke is drawn, what of the rim is to go fades, nothing else is lit, and what neighbours lose is said", () => {
  const { hand, state, tool } = denseSpot();
  // Out into the neighbour between its ends, which are 24 px off.
  const [first, ...way] = arcOfSpot(1, 20, 100).map(([x, y], i, all) => {
    const radius = 104 + 20 * Math.sin((Math.PI * i) / (all.length - 1));
    return /** @type {Point} */ ([600 + radius * (x - 600), 500 + radius * (y - 500)]);
  });
  hand.hover(first);
  hand.down(first);
  hand.drag(...way);
  const { strokes, words } = paintedBy(tool, state);
  assert.deepEqual([strokes.includes(FADED), state.selection.hovered], [true, null]);
  assert.deepEqual(words, ["takes from its neighbour"]);
});

test("a stroke that does nothing stays to be seen, and is all that undo takes back", () => {
  const { state, committed, hand, tool, said } = redrawing();
  hand.stroke(overQuarter(100));
  hand.stroke([
    [20, 20],
    [60, 40],
    [20, 60],
  ]);
  assert.deepEqual([committed.length, said.length], [1, 1]);
  assert.ok(paintedBy(tool, state).strokes.length > 0);
  assert.equal(tool.undo(), true);
  assert.equal(paintedBy(tool, state).strokes.length, 0);
  assert.equal(tool.undo(), false, "the next undo is for what was done before");
});

test("the next stroke takes the place of one that did nothing", () => {
  const { committed, hand } = redrawing();
  hand.stroke([
    [20, 20],
    [60, 40],
    [20, 60],
  ]);
  hand.stroke(overQuarter(100));
  assert.equal(committed.length, 1);
});
