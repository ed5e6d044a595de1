import assert from "node:assert/strict";
import test from "node:test";

import { movedShape } from "../../../static/editor/geometry/shapes.js";
import { LookSoon } from "../../../static/editor/sync/look_soon.js";
import { SQUARE, capOf } from "../support/caps.js";
import { openState, storedShape } from "../support/state.js";

const CAP = storedShape("u", capOf(SQUARE));

function staying() {
  const { state } = openState({ shapes: [CAP] });
  const looks = { count: 0 };
  return { state, looks, soon: new LookSoon(state, () => void looks.count++) };
}

test("the network looks at a photo on which somebody stays, once, and at none that is only leafed through", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { looks, soon } = staying();
  soon.begin();
  context.mock.timers.tick(1000);
  soon.stop();
  context.mock.timers.tick(10_000);
  assert.equal(looks.count, 0);
  soon.begin();
  context.mock.timers.tick(1000);
  soon.begin();
  context.mock.timers.tick(10_000);
  assert.equal(looks.count, 1);
});

test("the network does not look while a cap is in hand, and does once it is let go", (context) => {
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const { state, looks, soon } = staying();
  soon.begin();
  state.propose([movedShape(CAP, 5, 0)]);
  for (let seconds = 0; seconds < 20; seconds++) context.mock.timers.tick(1000);
  assert.equal(looks.count, 0);
  state.commitDrafts();
  context.mock.timers.tick(1500);
  assert.equal(looks.count, 1);
});
