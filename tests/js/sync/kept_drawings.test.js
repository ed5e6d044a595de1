import assert from "node:assert/strict";
import test from "node:test";

import { HalfDrawn } from "../../../static/editor/state/half_drawn.js";
import { KeptDrawings } from "../../../static/editor/sync/kept_drawings.js";
import { MemoryStorage } from "../support/memory_storage.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */

/** @type {Point[]} */
const POINTS = [
  [1, 2],
  [30, 2.5],
  [30, 40],
];

/** Tabs of one browser: storage and locks are theirs together. */
function browser() {
  const storage = new MemoryStorage();
  /** @type {Set<string>} */
  const locks = new Set();
  /** @type {(project?: string) => {halfDrawn: HalfDrawn, drawings: KeptDrawings, close: () => void}} */
  const tab = (project = "beds") => {
    /** @type {string[]} */
    const own = [];
    const lock = (/** @type {string} */ name) => {
      const free = !locks.has(name);
      if (free) own.push(name);
      locks.add(name);
      return Promise.resolve(free);
    };
    const halfDrawn = new HalfDrawn();
    const drawings = new KeptDrawings(halfDrawn, { storage, lock });
    drawings.use(project);
    return { halfDrawn, drawings, close: () => own.forEach((name) => locks.delete(name)) };
  };
  return { storage, tab };
}

/** @type {(tab: {halfDrawn: HalfDrawn, drawings: KeptDrawings}, image?: number) => Promise<void>} */
async function draw({ halfDrawn, drawings }, image = 1) {
  await drawings.open(image);
  for (const point of POINTS) halfDrawn.add(point);
}

test("what is half drawn on an image is there again when one comes back to it", async () => {
  const tab = browser().tab();
  await draw(tab);
  assert.equal(tab.drawings.leave(), true);
  assert.deepEqual([await tab.drawings.open(2), tab.halfDrawn.points], [false, []]);
  assert.equal(tab.drawings.leave(), false);
  assert.deepEqual([await tab.drawings.open(1), tab.halfDrawn.points], [true, POINTS]);
});

test("it is there again after the page was loaded anew, though nobody left the image", async () => {
  const { tab } = browser();
  const before = tab();
  await draw(before);
  before.drawings.write();
  before.close();
  const after = tab();
  assert.deepEqual([await after.drawings.open(1), after.halfDrawn.points], [true, POINTS]);
});

test("what was closed, dropped or taken back to the last point is not kept", async () => {
  const { storage, tab } = browser();
  for (const end of ["begin", "drop", "undo"]) {
    const one = tab();
    await draw(one);
    one.drawings.write();
    assert.equal(storage.length, 1);
    if (end === "begin") one.halfDrawn.begin([]);
    else if (end === "drop") one.halfDrawn.drop();
    else while (one.halfDrawn.undo());
    one.drawings.write();
    assert.equal(storage.length, 0);
  }
});

test("two tabs on one image keep an outline each", async () => {
  const { tab } = browser();
  const [one, other] = [tab(), tab()];
  await draw(one);
  one.drawings.write();
  assert.equal(await other.drawings.open(1), false);
  other.halfDrawn.add([7, 7]);
  other.drawings.write();
  one.close();
  other.close();
  const third = tab();
  await third.drawings.open(1);
  const first = third.halfDrawn.points;
  third.halfDrawn.begin([]);
  third.drawings.write();
  third.drawings.leave();
  await third.drawings.open(1);
  assert.deepEqual(
    [first, third.halfDrawn.points].sort((a, b) => a.length - b.length),
    [[[7, 7]], POINTS],
  );
});

test("another project's outlines stay where they are", async () => {
  const { tab } = browser();
  const one = tab("beds");
  await draw(one);
  one.drawings.write();
  one.close();
  assert.equal(await tab("farm").drawings.open(1), false);
});

test("what somebody has begun meanwhile is not replaced", async () => {
  const { tab } = browser();
  const one = tab();
  await draw(one);
  one.drawings.write();
  one.close();
  const after = tab();
  const opening = after.drawings.open(1);
  after.halfDrawn.add([9, 9]);
  assert.deepEqual([await opening, after.halfDrawn.points], [false, [[9, 9]]]);
});

test("what makes no sense in the storage is cleared away", async () => {
  const { storage, tab } = browser();
  for (const [i, text] of ["{", "[[1]]", '["a"]', "null", "[]"].entries())
    storage.setItem(`fairyring:drawing:beds:1:${i}`, text);
  assert.equal(await tab().drawings.open(1), false);
  assert.equal(storage.length, 0);
});

test("where the storage is full, it is said that nothing is kept, until there is room", async () => {
  const { storage, tab } = browser();
  const one = tab();
  storage.room = 20;
  await draw(one);
  assert.equal(one.drawings.kept, false);
  storage.room = Infinity;
  assert.equal(one.drawings.kept, true);
});
