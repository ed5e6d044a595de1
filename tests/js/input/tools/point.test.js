import assert from "node:assert/strict";
import test from "node:test";

import { PointTool } from "../../../../static/editor/input/tools/point.js";
import { capOf } from "../../support/caps.js";
import { handOf } from "../../support/hand.js";
import { openState, storedShape } from "../../support/state.js";

/** @typedef {import("../../../../static/editor/input/tools/point.js").Question} Question */

const THERE = [600, 100, 700, 100, 700, 200, 600, 200];
const LABELLED = [100, 100, 200, 100, 200, 200, 100, 200];

/** A network that sees one cap, larger by ten pixels for every further point. */
function pointing() {
  const { state, committed } = openState({ shapes: [storedShape("u", capOf(LABELLED))] });
  /** @type {{question: Question, keep: boolean}[]} */
  const asked = [];
  /** @type {string[]} */
  const said = [];
  const ask = async (/** @type {Question} */ question, /** @type {{keep: boolean}} */ { keep }) => {
    asked.push({ question, keep });
    const [x] = question.points[0] ?? question.box ?? [0];
    const more = 10 * Math.max(question.points.length - 1, 0);
    const visible = x >= 590 ? [THERE.map((value, i) => (i === 2 || i === 4 ? value + more : value))] : null;
    return { type: /** @type {const} */ ("found_cap"), seq: 1, image: 1, visible, score: visible && 0.8 };
  };
  const tool = new PointTool(state, (text) => void said.push(text), { ask, busy: () => false });
  const hand = handOf(state, tool);
  const rights = () => committed.flat().map(({ after }) => after.cap.visible[0][2]);
  return { state, committed, asked, said, tool, hand, rights };
}

/** Until the pointer counts as resting, and its question is answered. */
const rested = () => new Promise((resolve) => setTimeout(resolve, 60));

test("a click takes the cap that the network sees there, and selects it", async () => {
  const { state, asked, hand, rights } = pointing();
  hand.click([650, 150]);
  await rested();
  assert.deepEqual(rights(), [700]);
  assert.equal(asked[0].keep, true);
  assert.equal(state.sole?.cap.visible[0][0], 600);
});

test("where the pointer rests the network is asked, and a click takes what was shown without asking again", async () => {
  const { asked, hand, rights } = pointing();
  hand.hover([650, 150]);
  hand.hover([652, 150]);
  await rested();
  assert.deepEqual(asked.map(({ question, keep }) => [question.points, keep]), [[[[652, 150]], false]]);
  hand.down([652, 150]);
  hand.up([652, 150]);
  assert.deepEqual([rights(), asked.length], [[700], 1]);
});

test("with Shift a further point adds to the cap that was taken, with Alt one takes away", async () => {
  const { state, asked, hand, rights } = pointing();
  hand.click([650, 150]);
  await rested();
  hand.click([710, 150], { shift: true });
  await rested();
  hand.click([605, 150], { alt: true });
  await rested();
  assert.deepEqual(rights(), [700, 710, 720]);
  assert.deepEqual(asked.at(-1)?.question.wanted, [true, true, false]);
  assert.equal(state.items.all.length, 2);
});

test("a box asks for the cap in it", async () => {
  const { asked, hand, rights } = pointing();
  hand.stroke([
    [720, 220],
    [640, 150],
    [590, 90],
  ]);
  await rested();
  assert.deepEqual(asked.at(-1)?.question.box, [590, 90, 720, 220]);
  assert.deepEqual(rights(), [700]);
});

test("on a cap that is there the network is not asked: a click selects that", async () => {
  const { state, asked, hand } = pointing();
  hand.click([150, 150]);
  await rested();
  assert.deepEqual([asked.length, state.selection.soleUid], [0, "u"]);
});

test("where the network sees none, that is said and nothing is made", async () => {
  const { said, hand, committed } = pointing();
  hand.click([400, 400]);
  await rested();
  assert.deepEqual([said.length, committed.length], [1, 0]);
});
