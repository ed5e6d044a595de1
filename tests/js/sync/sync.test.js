import assert from "node:assert/strict";
import test from "node:test";

import { newShape } from "../../../static/editor/geometry/shapes.js";
import { Store } from "../../../static/editor/state/store.js";
import { Outbox } from "../../../static/editor/sync/outbox.js";
import { Sync } from "../../../static/editor/sync/sync.js";
import { capOf, triangle } from "../support/caps.js";
import { MemoryStorage } from "../support/memory_storage.js";

/** @typedef {import("../../../static/editor/protocol.js").Edits} Edits */

/** A sync whose messages go nowhere, what it has sent, and how often it gave up waiting. */
function alone() {
  /** @type {Edits[]} */
  const sent = [];
  const told = { stalled: 0 };
  const sync = new Sync({
    store: new Store(),
    send: (message) => sent.push(/** @type {Edits} */ (message)) > 0,
    stalled: () => void told.stalled++,
    progress: () => {},
    refused: () => {},
    travelled: () => {},
    stuck: () => {},
  });
  sync.use(new Outbox(new MemoryStorage(), "p:"));
  return { sync, sent, told };
}

test("a server that says that it is at work is waited for, and a silent one is not", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { sync, told } = alone();
  sync.commit([{ before: null, after: newShape("u", capOf(triangle(1))) }]);
  for (let i = 0; i < 10; i++) {
    context.mock.timers.tick(14_000);
    sync.heard();
  }
  assert.equal(told.stalled, 0);
  context.mock.timers.tick(15_000);
  assert.equal(told.stalled, 1);
});

test("accepting two thousand caps is sent a hundred at a time, and the next hundred when those are answered", () => {
  const { sync, sent } = alone();
  const uids = Array.from({ length: 2000 }, (_, i) => `u${i}`);
  sync.commit(uids.map((uid, i) => ({ before: null, after: newShape(uid, capOf(triangle(i))) })));
  while (sync.waiting) {
    const { edits } = /** @type {Edits} */ (sent.at(-1));
    assert.equal(edits.length, 100);
    sync.receive(
      edits.map(({ id, annotation, cap }) => {
        assert.ok(cap);
        const fit = { whole: null, centre: null, centre_sd: null };
        const stored = { uid: annotation, image: 0, revision: 1, cap, deleted: false, ...fit, extra: {} };
        return { outcome: "accepted", edit: id, annotation: stored };
      }),
    );
  }
  assert.equal(sent.length, 20);
  assert.equal(new Set(sent.flatMap(({ edits }) => edits.map((edit) => edit.change_set))).size, 1);
});
