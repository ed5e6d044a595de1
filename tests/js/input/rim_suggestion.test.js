import assert from "node:assert/strict";
import test from "node:test";

import { newShape } from "../../../static/editor/geometry/shapes.js";
import { RimSuggestion } from "../../../static/editor/input/rim_suggestion.js";
import { capOf, triangle } from "../support/caps.js";
import { openState } from "../support/state.js";

/** @typedef {import("../../../static/editor/protocol.js").Cap} Cap */

/** What is offered, where each look at the photo ends only once it is told to. */
function slow() {
  const { state } = openState();
  /** @type {{x: number, end: (cap: Cap | null) => void}[]} */
  const looks = [];
  const suggestion = new RimSuggestion(state, {
    tightened: async () => null,
    tightenedByPhoto: ({ cap }) => new Promise((end) => void looks.push({ x: cap.visible[0][0], end })),
  });
  return { looks, suggestion, drawn: (/** @type {number} */ x) => state.signals.drawing.emit(newShape("", capOf(triangle(x)))), stop: () => state.signals.drawing.emit(null) };
}

const settled = () => new Promise((resolve) => setTimeout(resolve));

test("while a circle is drawn out one look follows another, and what came meanwhile is passed over but for the last", async () => {
  const { looks, suggestion, drawn } = slow();
  for (const x of [1, 2, 3]) drawn(x);
  looks[0].end(capOf(triangle(1)));
  await settled();
  assert.deepEqual(looks.map(({ x }) => x), [triangle(1)[0], triangle(3)[0]]);
  assert.deepEqual(suggestion.shown, capOf(triangle(1)));
});

test("once the circle is let go nothing that was looked for during the drag is shown", async () => {
  const { looks, suggestion, drawn, stop } = slow();
  drawn(1);
  stop();
  looks[0].end(capOf(triangle(1)));
  await settled();
  assert.equal(suggestion.shown, null);
});
