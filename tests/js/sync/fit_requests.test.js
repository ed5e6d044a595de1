import assert from "node:assert/strict";
import test from "node:test";

import { FitRequests } from "../../../static/editor/sync/fit_requests.js";
import { capOf, triangle } from "../support/caps.js";

/** @typedef {import("../../../static/editor/protocol.js").ToServer} ToServer */

/** The question about a cap whose outline begins at x. @type {(x: number) => import("../../../static/editor/sync/fit_requests.js").Question} */
const question = (x) => ({ image: 1, annotation: "u", cap: capOf(triangle(x)) });

/** @type {(seq: number) => import("../../../static/editor/protocol.js").Fitted} */
const fitted = (seq) => {
  const fit = { whole: null, centre: null, centre_sd: null, refusal: null };
  return { type: "fit", seq, annotation: "u", fit, arcs: [], note: "", mark: null };
};

/** Requests, and what they have sent: number and x. */
function requests() {
  /** @type {[number, number][]} */
  const sent = [];
  const asking = new FitRequests((message) => {
    if (message.type === "refit") sent.push([message.seq, message.cap.visible[0][0]]);
    return true;
  });
  return { asking, sent };
}

test("one fit is asked for at a time, and of the questions that wait the latest", () => {
  const { asking, sent } = requests();
  for (const x of [1, 2, 3]) asking.ask(question(x));
  assert.deepEqual(sent, [[1, 1]]);
  assert.equal(asking.take(fitted(99)), null);
  assert.deepEqual(asking.take(fitted(1)), question(1));
  assert.deepEqual(asking.take(fitted(2)), question(3));
  assert.deepEqual(sent, [
    [1, 1],
    [2, 3],
  ]);
});

test("a question that was given up does not hold up the next, and its answer is not taken", () => {
  const { asking, sent } = requests();
  asking.ask(question(1));
  asking.ask(question(2));
  asking.forget();
  asking.ask(question(3));
  assert.deepEqual(sent, [
    [1, 1],
    [2, 3],
  ]);
  assert.equal(asking.take(fitted(1)), null);
  assert.deepEqual(asking.take(fitted(2)), question(3));
});

test("what could not be sent is not waited for", () => {
  let up = false;
  const asking = new FitRequests(() => up);
  asking.ask(question(1));
  up = true;
  asking.ask(question(2));
  assert.deepEqual(asking.take(fitted(2)), question(2));
});
