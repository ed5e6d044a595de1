import assert from "node:assert/strict";
import test from "node:test";

import { Outbox } from "../../../static/editor/sync/outbox.js";
import { keysWith } from "../../../static/editor/sync/stored_edits.js";
import { capOf, triangle } from "../support/caps.js";
import { MemoryStorage } from "../support/memory_storage.js";

/** @typedef {import("../../../static/editor/sync/outbox.js").CapEdit} CapEdit */
/** @typedef {import("../../../static/editor/sync/outbox.js").Edit} Edit */
/** @typedef {import("../../../static/editor/sync/outbox.js").StatusEdit} StatusEdit */

const MADE = { image: 1, change_set: "s", takes_back: "" };
/** @type {(id: string, annotation?: string, cap?: CapEdit["cap"]) => CapEdit} */
const edit = (id, annotation = "u", cap = capOf(triangle(1))) => ({ id, annotation, base: 0, cap, ...MADE });
/** @type {(...ids: string[]) => CapEdit[]} */
const edits = (...ids) => ids.map((id) => edit(id));
/** @type {(edits: Edit[]) => string[]} */
const idsOf = (edits) => edits.map(({ id }) => id);
/** As older versions kept a change set. @type {(storage: Storage, key: string, edits: Edit[]) => void} */
const putOld = (storage, key, edits) => storage.setItem(key, JSON.stringify(edits));

test("unacknowledged edits are there after a reload, in their order and their change sets", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  for (let i = 0; i < 12; i++) outbox.add(edits(`${i}a`, `${i}b`));
  for (const id of ["0a", "0b", "1a", "3b"]) outbox.acknowledged(id);
  const again = new Outbox(storage, "p:");
  assert.deepEqual(again.edits(), outbox.edits());
  assert.deepEqual(idsOf(again.head()), ["1b"]);
  again.acknowledged("1b");
  assert.deepEqual(idsOf(again.head()), ["2a", "2b"]);
  assert.ok(again.kept);
});

test("more than ten edits of one change set keep their order over a reload", () => {
  const storage = new MemoryStorage();
  const ids = Array.from({ length: 1200 }, (_, i) => `e${i}`);
  new Outbox(storage, "p:").add(edits(...ids));
  assert.deepEqual(idsOf(new Outbox(storage, "p:").edits()), ids);
});

test("a large change set is sent in pieces, in its order, and never together with the next one", () => {
  const outbox = new Outbox(new MemoryStorage(), "p:");
  const ids = Array.from({ length: 250 }, (_, i) => `e${i}`);
  outbox.add(edits(...ids));
  outbox.add(edits("next"));
  const pieces = [];
  for (let head = outbox.head(); head.length; head = outbox.head()) {
    pieces.push(idsOf(head));
    for (const { id } of head) outbox.acknowledged(id);
  }
  assert.deepEqual(pieces, [ids.slice(0, 100), ids.slice(100, 200), ids.slice(200), ["next"]]);
});

test("a piece holds few edits where they are long, and one where that is longer than a piece may be", () => {
  const outbox = new Outbox(null, "p:");
  const long = capOf(Array.from({ length: 30_000 }, (_, i) => 1000 + i / 2));
  outbox.add([...["a", "b", "c"].map((id) => edit(id, id, long)), edit("d", "d", capOf([0, 1, 2].flatMap(() => long.visible[0])))]);
  const sizes = [];
  for (let head = outbox.head(); head.length; head = outbox.head()) {
    sizes.push(head.length);
    for (const { id } of head) outbox.acknowledged(id);
  }
  assert.deepEqual(sizes, [2, 1, 1]);
});

test("a change of status waits and is kept as an edit of a cap is", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  /** @type {StatusEdit} */
  const status = { id: "s", before: "new", after: "annotated", ...MADE };
  outbox.add(edits("a"));
  outbox.add([status]);
  assert.deepEqual(new Outbox(storage, "p:").edits(), [edit("a"), status]);
  outbox.acknowledged("a");
  assert.deepEqual([outbox.head(), outbox.waiting], [[status], 1]);
  outbox.acknowledged("s");
  assert.equal(storage.length, 0);
});

test("an edit that is rewritten keeps its place, here and over a reload", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits("a", "b", "c"));
  outbox.rewrite({ ...edit("b"), base: 7 });
  assert.deepEqual(
    new Outbox(storage, "p:").of("u").map(({ id, base }) => [id, base]),
    [["a", 0], ["b", 7], ["c", 0]],
  );
  assert.equal(outbox.of("u")[1].base, 7);
});

test("edits added after a reload come after older ones", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits("a"));
  outbox.add(edits("b"));
  outbox.acknowledged("a");
  new Outbox(storage, "p:").add(edits("c"));
  assert.deepEqual(idsOf(new Outbox(storage, "p:").edits()), ["b", "c"]);
});

test("acknowledged edits leave nothing in the browser", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits("a", "b"));
  outbox.acknowledged("a");
  outbox.acknowledged("b");
  assert.deepEqual([storage.length, outbox.waiting, outbox.head()], [0, 0, []]);
});

for (const count of [250, 1000]) {
  test(`of ${count} edits each is written once, and nothing when it is acknowledged`, () => {
    const storage = new MemoryStorage();
    const outbox = new Outbox(storage, "p:");
    const all = edits(...Array.from({ length: count }, (_, i) => `e${i}`));
    outbox.add(all);
    const kept = keysWith(storage, "p:").map((key) => key.length + (storage.getItem(key)?.length ?? 0));
    const total = kept.reduce((sum, size) => sum + size);
    assert.deepEqual([kept.length, storage.written], [count, total]);
    assert.ok(total < count * (JSON.stringify(all[0]).length + 30));
    for (const { id } of all) outbox.acknowledged(id);
    assert.deepEqual([storage.length, storage.written], [0, total]);
  });
}

test("what a closed tab left is taken over once, after what is here, in its order", () => {
  const storage = new MemoryStorage();
  const old = new Outbox(storage, "p:old:");
  old.add(edits("a", "b"));
  old.add(edits("c"));
  old.acknowledged("a");
  const outbox = new Outbox(storage, "p:new:");
  outbox.add(edits("mine"));
  outbox.adopt("p:old:");
  assert.deepEqual(idsOf(outbox.edits()), ["mine", "b", "c"]);
  assert.deepEqual(idsOf(outbox.head()), ["mine"]);
  assert.deepEqual(keysWith(storage, "p:old:"), []);
  const again = new Outbox(storage, "p:new:");
  assert.deepEqual(again.edits(), outbox.edits());
  again.acknowledged("mine");
  assert.deepEqual(idsOf(again.head()), ["b"]);
});

test("what an older version kept is taken over, in its order, and written anew", () => {
  const storage = new MemoryStorage();
  putOld(storage, "p:000000004", edits("a", "b"));
  putOld(storage, "p:000000011", edits("c"));
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits("d"));
  assert.deepEqual(idsOf(outbox.edits()), ["a", "b", "c", "d"]);
  assert.deepEqual(idsOf(outbox.head()), ["a", "b"]);
  outbox.acknowledged("a");
  assert.deepEqual(idsOf(new Outbox(storage, "p:").edits()), ["b", "c", "d"]);
  assert.equal(storage.getItem("p:000000004"), null);
});

test("what an older version kept in a tab closed since is taken over too", () => {
  const storage = new MemoryStorage();
  putOld(storage, "p:old:000000000", edits("a", "b"));
  const outbox = new Outbox(storage, "p:new:");
  outbox.adopt("p:old:");
  assert.deepEqual(idsOf(new Outbox(storage, "p:new:").edits()), ["a", "b"]);
  assert.deepEqual(keysWith(storage, "p:old:"), []);
});

test("a crash while an older entry is taken over loses nothing and doubles nothing", () => {
  const storage = new MemoryStorage();
  putOld(storage, "p:000000000", edits("a", "b", "c"));
  const before = storage.getItem("p:000000000") ?? "";
  new Outbox(storage, "p:");
  storage.removeItem("p:000000000.000002");
  storage.setItem("p:000000000", before);
  const outbox = new Outbox(storage, "p:");
  assert.deepEqual(idsOf(outbox.edits()), ["a", "b", "c"]);
  for (const id of ["a", "b", "c"]) outbox.acknowledged(id);
  assert.deepEqual([storage.length, outbox.lastOf("u")], [0, null]);
});

test("an older entry is taken over also where there is no room for it twice", () => {
  const storage = new MemoryStorage();
  putOld(storage, "p:000000000", edits(...Array.from({ length: 20 }, (_, i) => `e${i}`)));
  storage.room = storage.written * 1.3;
  const outbox = new Outbox(storage, "p:");
  assert.ok(outbox.kept);
  assert.deepEqual(new Outbox(storage, "p:").edits(), outbox.edits());
  assert.equal(outbox.waiting, 20);
});

test("a full storage is admitted until there is room again", () => {
  const storage = new MemoryStorage();
  const outbox = new Outbox(storage, "p:");
  outbox.add(edits("a"));
  storage.room = storage.written;
  outbox.add(edits("b"));
  assert.equal(outbox.kept, false);
  outbox.acknowledged("a");
  assert.equal(outbox.kept, true);
  assert.deepEqual(idsOf(new Outbox(storage, "p:").edits()), ["b"]);
});

test("without any storage edits wait all the same, and that they are not kept is admitted", () => {
  const outbox = new Outbox(null, "p:");
  outbox.add(edits("a"));
  assert.deepEqual([idsOf(outbox.head()), outbox.kept], [["a"], false]);
  outbox.acknowledged("a");
  assert.deepEqual([outbox.head(), outbox.kept], [[], true]);
});

test("spoilt entries are passed over and left where they are", () => {
  const storage = new MemoryStorage();
  for (const [i, text] of ["{broken", "7", "null", "[null]", "{}"].entries())
    storage.setItem(`p:00000000${i}`, text);
  storage.setItem("p:something else", JSON.stringify(edits("a")));
  assert.deepEqual(new Outbox(storage, "p:").edits(), []);
  assert.equal(storage.length, 6);
});

test("an edit held for a person stands for all of its cap and is not sent", () => {
  const outbox = new Outbox(new MemoryStorage(), "p:");
  outbox.add([edit("a", "u"), edit("b", "v")]);
  outbox.add([edit("c", "u")]);
  outbox.hold(edit("d", "u"));
  assert.deepEqual([idsOf(outbox.edits()), idsOf(outbox.head()), outbox.waiting], [["b", "d"], ["b"], 1]);
  assert.deepEqual([outbox.holds("u"), outbox.holds("v")], [true, false]);
  assert.deepEqual([outbox.lastOf("u")?.id, outbox.lastOf("v")?.id, outbox.lastOf("w")], ["d", "b", null]);
  outbox.drop("u");
  assert.deepEqual([outbox.holds("u"), idsOf(outbox.edits())], [false, ["b"]]);
});
