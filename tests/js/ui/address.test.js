import assert from "node:assert/strict";
import test from "node:test";

import { addressIn, hashOf } from "../../../static/editor/ui/address.js";

test("an image and a cap have an address, which leads back to them", () => {
  for (const address of [
    { image: 12, cap: null },
    { image: 12, cap: "b682f0" },
    { image: 3, cap: "bed 1/cap ä" },
  ])
    assert.deepEqual(addressIn(hashOf(address)), address);
  assert.equal(hashOf({ image: 12, cap: "b682f0" }), "#/image/12/cap/b682f0");
});

test("what is no address leads nowhere", () => {
  for (const hash of ["", "#", "#/image/", "#/image/x", "#/image/1/cap", "#/image/1/cap/a/b", "#/cap/1"])
    assert.equal(addressIn(hash), null);
  assert.deepEqual(addressIn("#/image/1/cap/%E0"), { image: 1, cap: null });
});
