import assert from "node:assert/strict";
import test from "node:test";

import { newShape } from "../../../static/editor/geometry/shapes.js";
import { Store } from "../../../static/editor/state/store.js";
import { Outbox } from "../../../static/editor/sync/outbox.js";
import { Sync } from "../../../static/editor/sync/sync.js";
import { capOf, triangle } from "../support/caps.js";
import { MemoryStorage } from "../support/memory_storage.js";
import { IMAGE } from "../support/state.js";

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

test("who approves learns whether it was stored, and a second key of the same waits for nothing", async () => {
  const { sync, sent } = alone();
  sync.open({ ...IMAGE, id: 3, status: "annotated" }, [], []);
  const approved = sync.say("approved");
  assert.equal(await sync.say("approved"), false);
  const [{ id }] = /** @type {Edits} */ (sent.at(-1)).statuses;
  sync.receive([{ outcome: "status", edit: id, image: 3, status: "approved" }]);
  assert.equal(await approved, true);
  assert.equal(sent.length, 1);
});

test("who approves what is refused learns that, and the image is as it was", async () => {
  const { sync, sent } = alone();
  sync.open({ ...IMAGE, id: 3, status: "annotated" }, [], []);
  const approved = sync.say("approved");
  const [{ id }] = /** @type {Edits} */ (sent.at(-1)).statuses;
  sync.receive([{ outcome: "refused", edit: id, reason: "You have labelled it." }]);
  assert.equal(await approved, false);
  assert.equal(sync.status, "annotated");
});

test("the key pressed twice leads nobody on, but an answer about another image holds nobody up", async () => {
  const { sync } = alone();
  sync.open({ ...IMAGE, id: 3, status: "annotated" }, [], []);
  sync.say("approved");
  assert.equal(await sync.say("approved"), false);
  sync.open({ ...IMAGE, id: 4, status: "approved" }, [], []);
  assert.equal(await sync.say("approved"), true);
});

test("nobody is held up by a line that is broken: what was said is sent later", async () => {
  const { sync } = alone();
  sync.open({ ...IMAGE, id: 3, status: "annotated" }, [], []);
  const sentBack = sync.judge(null, "sent_back", "Caps are missing");
  sync.pause();
  assert.equal(await sentBack, true);
  assert.equal(sync.waiting, 1);
});

test("what was said of a cap is withdrawn by undo, said again by redo, and a comment is passed over", async () => {
  const { sync, sent } = alone();
  sync.open({ ...IMAGE, id: 3, status: "annotated" }, [], []);
  const answer = () => {
    const [verdict] = /** @type {Edits} */ (sent.at(-1)).verdicts;
    sync.receive([{ outcome: "status", edit: verdict.id, image: 3, status: "annotated" }]);
    return [verdict.annotation, verdict.says, verdict.words];
  };
  sync.judge("cap", "approved", "");
  assert.deepEqual(answer(), ["cap", "approved", ""]);
  sync.judge("cap", "comment", "Is it one?");
  assert.deepEqual(answer(), ["cap", "comment", "Is it one?"]);
  sync.undo();
  assert.deepEqual(answer(), ["cap", "withdrawn", ""]);
  sync.redo();
  assert.deepEqual(answer(), ["cap", "approved", ""]);
});

test("a rejection that left the status as it was is undone, too", () => {
  const { sync, sent } = alone();
  sync.open({ ...IMAGE, id: 3, status: "new" }, [], []);
  sync.judge(null, "rejected", "Too dark");
  assert.ok(sync.hasFinished(3));
  const [{ id }] = /** @type {Edits} */ (sent.at(-1)).verdicts;
  sync.receive([{ outcome: "status", edit: id, image: 3, status: "new" }]);
  sync.undo();
  const [{ says, annotation }] = /** @type {Edits} */ (sent.at(-1)).verdicts;
  assert.deepEqual([says, annotation], ["withdrawn", null]);
});
