import assert from "node:assert/strict";
import test from "node:test";

import { newCap } from "../../../static/editor/geometry/caps.js";
import { pick, within } from "../../../static/editor/geometry/hit.js";
import { isPrediction } from "../../../static/editor/geometry/shapes.js";
import { changed } from "../../../static/editor/state/changes.js";
import { capOf, prediction, star, triangle } from "../support/caps.js";
import { chances } from "../support/chances.js";
import { openState, storedShape } from "../support/state.js";

/** @typedef {ReturnType<typeof chances>} Random */
/** @typedef {import("../../../static/editor/state/editor_state.js").EditorState} EditorState */

/** @type {(shapes: {uid: string}[]) => string[]} */
const uids = (shapes) => shapes.map(({ uid }) => uid);

/** An outline somewhere, now and then a huge one. @type {(random: Random) => number[]} */
function somewhere(random) {
  const radius = random.chance(20) ? 700 : random.between(4, 60);
  return star(random, { x: random.between(0, 2000), y: random.between(0, 1500), radius, count: 9 });
}

/** @type {(random: Random) => import("../../../static/editor/protocol.js").Cap} */
function someCap(random) {
  if (random.chance(4)) return capOf(somewhere(random));
  const [cx, cy] = [random.between(0, 2000), random.between(0, 1500)];
  return newCap({ mark: { kind: "circle", cx, cy, r: random.between(3, 50) } });
}

/** One thing that happens to the image. @type {(state: EditorState, random: Random, step: number) => void} */
function happen(state, random, step) {
  const one = state.items.all[random.chance(Math.max(1, state.items.all.length))];
  const what = random.chance(8);
  if (what < 3 || !one)
    state.store.apply([{ before: null, after: storedShape(`new ${step}`, someCap(random)) }]);
  else if (what < 5)
    state.store.apply([
      changed(one, { ...one, cap: { ...someCap(random), prediction: one.cap.prediction } }),
    ]);
  else if (what === 5) state.store.apply([changed(one, { ...one, deleted: true })]);
  else if (what === 6) state.layers.visible = { ...state.layers.visible, prediction: random.chance(2) === 0 };
  else state.predict(Array.from({ length: 30 }, (_, i) => prediction(1000 * step + i, [somewhere(random)])));
}

for (let seed = 0; seed < 10; seed++) {
  test(`what the index finds under the pointer is what a look at every cap finds (${seed})`, () => {
    const random = chances(seed);
    const { state } = openState();
    let hits = 0;
    for (let step = 0; step < 150; step++) {
      happen(state, random, step);
      const { all } = state.items;
      const visible = state.layers.visible.prediction ? all : all.filter((shape) => !isPrediction(shape));
      for (let i = 0; i < 10; i++) {
        /** @type {[number, number]} */
        const point = [random.between(-50, 2050), random.between(-50, 1550)];
        const reach = random.between(0, 40);
        const found = pick(visible, point, reach);
        assert.equal(state.at(point, reach), found);
        hits += found ? 1 : 0;
        const [x1, y1] = [point[0] + random.between(0, 600), point[1] + random.between(0, 600)];
        const band = { x0: point[0], y0: point[1], x1, y1 };
        assert.deepEqual(uids(within(state.near(band), band)), uids(within(visible, band)));
      }
    }
    assert.ok(hits > 100);
  });
}

test("every item is found by its uid as it is now, and one that is gone is not", () => {
  const { state } = openState({
    shapes: [storedShape("u", capOf(triangle(0)))],
    predictions: [prediction(1)],
  });
  const before = state.items.get("u");
  assert.ok(before);
  state.store.apply([{ before, after: { ...before, revision: 2 } }]);
  assert.equal(state.items.get("u")?.revision, 2);
  state.store.apply([{ before, after: { ...before, deleted: true } }]);
  assert.equal(state.items.get("u"), null);
  assert.deepEqual(uids(state.items.all), ["prediction:1"]);
});

test("a prediction is an item until it is taken up, and again when that is undone", () => {
  const { state } = openState({ predictions: [prediction(1), prediction(2)] });
  const taken = storedShape("u", { ...capOf(triangle(0)), prediction: 1 });
  state.store.apply([{ before: null, after: taken }]);
  assert.deepEqual(uids(state.items.all), ["prediction:2", "u"]);
  const released = { ...taken, deleted: true, cap: { ...taken.cap, prediction: null } };
  state.store.apply([{ before: taken, after: released }]);
  assert.deepEqual(uids(state.items.all), ["prediction:1", "prediction:2"]);
});
