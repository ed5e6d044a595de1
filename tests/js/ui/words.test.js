import assert from "node:assert/strict";
import test from "node:test";

import { ARCS } from "../../../static/editor/render/palette.js";
import { captionOf } from "../../../static/editor/ui/caption.js";
import { statusOf } from "../../../static/editor/ui/status.js";

/** @typedef {Parameters<typeof statusOf>[0]} State */

/** @type {State} */
const QUIET = { connection: "online", waiting: 0, kept: true, conflicts: 0 };

/** @type {[Partial<State>, string][]} */
const LINES = [
  [{}, "Saved"],
  [{ waiting: 1 }, "Saving 1 edit…"],
  [{ connection: "connecting" }, "Connecting"],
  [{ connection: "offline", waiting: 3 }, "Offline, 3 edits kept in this browser"],
  [{ conflicts: 2 }, "Saved · 2 conflicts to settle"],
];

for (const [state, text] of LINES) {
  test(`the status line says “${text}” when that is so`, () =>
    assert.equal(statusOf({ ...QUIET, ...state }).text, text));
}

test("the status line never says saved when edits could not be kept", () => {
  const { text, tone } = statusOf({ connection: "offline", waiting: 2, kept: false, conflicts: 0 });
  assert.match(text, /not saved/);
  assert.equal(tone, "bad");
});

/** @type {import("../../../static/editor/protocol.js").Fit} */
const FIT = { whole: null, centre: null, centre_sd: null, refusal: null };

test("the caption gives the reason and how well the centre is known", () => {
  const known = { ...FIT, centre_sd: /** @type {[number, number]} */ ([0.1234, 2]) };
  assert.equal(captionOf({ note: "regular", fit: known, mark: "circle" }), "regular · centre ± 0.12, 2.00 px · M: mark a circle");
  assert.equal(captionOf({ note: "the marked circle", fit: FIT, mark: null }), "the marked circle");
});

test("arcs of all kinds differ by dash alone", () => {
  const dashes = Object.values(ARCS).map(({ dash }) => dash.join());
  assert.deepEqual([dashes.length, new Set(dashes).size], [5, 5]);
});
