/**
 * How long the editor looks for caps on an image of 2000, beside a look at every cap, and what an outbox
 * writes for 1000 edits. Run by `make bench`; prints milliseconds, best of several rounds.
 *
 * @module
 */

import { pick, within } from "../../static/editor/geometry/hit.js";
import { Outbox } from "../../static/editor/sync/outbox.js";
import { capOf, star, triangle } from "./support/caps.js";
import { chances } from "./support/chances.js";
import { MemoryStorage } from "./support/memory_storage.js";
import { openState, storedShape } from "./support/state.js";

const CAPS = 2000;
const QUESTIONS = 500;
const ROUNDS = 7;

const random = chances(1);
const somewhere = () => ({ x: random.between(0, 2000), y: random.between(0, 1500) });
const shapes = Array.from({ length: CAPS }, (_, i) =>
  storedShape(`cap ${i}`, capOf(star(random, { ...somewhere(), radius: 22, count: 20 }))),
);
const { state } = openState({ shapes });
const points = Array.from(
  { length: QUESTIONS },
  () => /** @type {[number, number]} */ (Object.values(somewhere())),
);
const uids = points.map(() => `cap ${random.chance(CAPS)}`);
const bands = points.map(([x, y]) => ({ x0: x, y0: y, x1: x + 200, y1: y + 200 }));

/** The quickest of several rounds, ms. @type {(work: () => void) => number} */
function best(work) {
  const rounds = Array.from({ length: ROUNDS }, () => {
    const start = performance.now();
    work();
    return performance.now() - start;
  });
  return Math.min(...rounds);
}

/** @type {(what: string, found: () => void, every: () => void) => void} */
function compare(what, found, every) {
  const [quick, slow] = [best(found) / QUESTIONS, best(every) / QUESTIONS];
  const gain = `${(slow / quick).toFixed(1)} times quicker`;
  process.stdout.write(`${what}: ${quick.toFixed(4)} ms (every cap: ${slow.toFixed(4)} ms), ${gain}\n`);
}

compare(
  `the cap under the pointer, of ${CAPS}`,
  () => points.forEach((point) => state.at(point, 6)),
  () => points.forEach((point) => pick(state.items.all, point, 6)),
);
compare(
  `the caps in a rubber band of 200 × 200 px, of ${CAPS}`,
  () => bands.forEach((band) => within(state.near(band), band)),
  () => bands.forEach((band) => within(state.items.all, band)),
);
compare(
  `a cap by its uid, of ${CAPS}`,
  () => uids.forEach((uid) => state.items.get(uid)),
  () => uids.forEach((uid) => state.items.all.find((shape) => shape.uid === uid)),
);

const moved = best(() => {
  const before = state.items.all[random.chance(CAPS)];
  state.store.apply([{ before, after: { ...before, cap: capOf(triangle(random.between(0, 2000))) } }]);
  state.items.get(before.uid);
});
process.stdout.write(`bringing the index up to date after an edit, of ${CAPS}: ${moved.toFixed(3)} ms\n`);

for (const count of [250, 1000]) {
  const edits = shapes.slice(0, count).map(({ uid, cap }, i) => {
    return { id: `edit ${i}`, annotation: uid, image: 1, base: 0, cap, change_set: "s", takes_back: "" };
  });
  const storage = new MemoryStorage();
  const start = performance.now();
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits);
  for (const { id } of edits) outbox.acknowledged(id);
  const took = performance.now() - start;
  const megabytes = storage.written / 1e6;
  process.stdout.write(
    `an outbox of ${count} edits, filled and acknowledged: ${megabytes.toFixed(2)} MB written, ${took.toFixed(1)} ms\n`,
  );
}
