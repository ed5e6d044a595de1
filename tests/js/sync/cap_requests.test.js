import assert from "node:assert/strict";
import test from "node:test";

import { CapRequests, LOOK } from "../../../static/editor/sync/cap_requests.js";

/** @typedef {import("../../../static/editor/protocol.js").FindCap} FindCap */

/** @type {(x: number) => {points: [number, number][], wanted: boolean[], box: null}} */
const at = (x) => ({ points: [[x, 0]], wanted: [true], box: null });

function asking({ online = true } = {}) {
  /** @type {FindCap[]} */
  const sent = [];
  const send = (/** @type {any} */ message) => {
    if (online) sent.push(message);
    return online;
  };
  const requests = new CapRequests(send, () => 7);
  const answer = (/** @type {FindCap} */ { seq, image }) =>
    requests.take({ type: "found_cap", seq, image, visible: [[0, 0, 9, 0, 0, 9]], score: 0.9 });
  const asked = () => sent.map(({ points }) => points[0]?.[0]);
  return { requests, sent, answer, asked };
}

test("one question is asked at a time, and of those that may be dropped only the latest waits", async () => {
  const { requests, sent, answer, asked } = asking();
  const first = requests.ask(at(1), { keep: false });
  const second = requests.ask(at(2), { keep: false });
  const third = requests.ask(at(3), { keep: false });
  assert.deepEqual(asked(), [1]);
  answer(sent[0]);
  answer(sent[1]);
  assert.deepEqual([(await first)?.score, await second, (await third)?.score], [0.9, null, 0.9]);
  assert.deepEqual([asked(), requests.busy], [[1, 3], false]);
});

test("what must be answered is asked before what may be dropped, in its order", () => {
  const { requests, sent, answer, asked } = asking();
  void requests.ask(at(1), { keep: false });
  void requests.ask(at(2), { keep: false });
  void requests.ask(at(3), { keep: true });
  void requests.ask(at(4), { keep: true });
  for (let i = 0; i < 4; i++) answer(sent[i]);
  assert.deepEqual(asked(), [1, 3, 4, 2]);
});

test("an answer to something else is not taken, and where nobody can be asked the answer is none", async () => {
  const { requests, sent, answer } = asking();
  const question = requests.ask(at(1), { keep: true });
  answer({ ...sent[0], seq: 99 });
  assert.equal(requests.busy, true);
  requests.forget();
  assert.equal(await question, null);
  assert.equal(await asking({ online: false }).requests.ask(at(1), { keep: true }), null);
});

test("where the network sees a rim is asked once it has seen the photo, and not of one it has not", async () => {
  const { requests, sent, answer } = asking();
  assert.equal(await requests.rimIn([0, 0, 9, 9], "cap"), null);
  assert.deepEqual([sent.length, requests.sees], [0, false]);
  void requests.ask(LOOK, { keep: false });
  answer(sent[0]);
  assert.equal(requests.sees, true);
  const rim = requests.rimIn([0, 0, 9, 9], "cap");
  assert.deepEqual([sent[1].box, sent[1].besides, sent[1].points], [[0, 0, 9, 9], "cap", []]);
  answer(sent[1]);
  assert.deepEqual(await rim, [0, 0, 9, 0, 0, 9]);
  requests.forget();
  assert.equal(requests.sees, false, "the line was broken: the server may be another");
});
