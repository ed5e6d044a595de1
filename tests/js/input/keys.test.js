import assert from "node:assert/strict";
import test from "node:test";

import DECLARED from "../../../static/editor/commands.js";
import { ACTIONS } from "../../../static/editor/input/actions.js";
import { commandOf, commandOfLayer, heldBy } from "../../../static/editor/input/keys.js";

const COMMANDS = DECLARED.groups.flatMap(({ commands }) => commands);
const NAMES = [
  ...COMMANDS.map(({ name }) => name),
  ...DECLARED.layers.map(({ name }) => commandOfLayer(name)),
];

/** What the browser tells of a key. @type {(fields: Partial<import("../../../static/editor/input/keys.js").Chord>) => import("../../../static/editor/input/keys.js").Chord} */
const chord = (fields) => {
  return { key: "", code: "", ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, ...fields };
};

test("every command that is declared has an action, and every action is declared once", () => {
  assert.deepEqual(Object.keys(ACTIONS).sort(), NAMES.sort());
});

test("no key runs two commands, and none that is held runs any", () => {
  const keys = [
    ...COMMANDS.flatMap((command) => command.keys),
    ...DECLARED.layers.map(({ key }) => key),
    ...DECLARED.held.map(({ key }) => key),
  ].map((key) => key.toLowerCase());
  assert.deepEqual(
    keys.filter((key, i) => keys.indexOf(key) !== i),
    [],
  );
});

test("every layer has a key of its own that shows and hides it", () => {
  for (const { name, key } of DECLARED.layers) assert.equal(commandOf(chord({ key })), commandOfLayer(name));
});

/** @type {[string, Partial<import("../../../static/editor/input/keys.js").Chord>, string | null][]} */
const CHORDS = [
  ["Ctrl+Z", { key: "z", ctrlKey: true }, "undo"],
  ["Ctrl+Shift+Z", { key: "Z", ctrlKey: true, shiftKey: true }, "redo"],
  ["Cmd+Z", { key: "z", metaKey: true }, "undo"],
  ["? on a keyboard where it takes Shift", { key: "?", shiftKey: true }, "help"],
  ["? on a keyboard where it does not", { key: "?" }, "help"],
  ["+ with Shift", { key: "+", shiftKey: true }, "zoom_in"],
  ["Shift+Tab", { key: "Tab", shiftKey: true }, "previous_cap"],
  ["Shift+A", { key: "A", shiftKey: true }, "accept_all"],
  ["A with Caps Lock on", { key: "A" }, "accept"],
  ["an arrow", { key: "ArrowLeft" }, "nudge_left"],
  ["an arrow with Shift", { key: "ArrowDown", shiftKey: true }, "push_down"],
  ["Escape", { key: "Escape" }, "cancel"],
  ["Delete", { key: "Delete" }, "delete"],
  ["Backspace", { key: "Backspace" }, "delete"],
  ["PageDown", { key: "PageDown" }, "next_image"],
  ["A where the layout types Cyrillic", { key: "ф", code: "KeyA" }, "accept"],
  ["Ctrl+R, which is the browser's", { key: "r", ctrlKey: true }, null],
  ["Alt+A, which is nobody's", { key: "a", altKey: true }, null],
];

for (const [what, fields, command] of CHORDS) {
  test(`${what} runs ${command ?? "nothing"}`, () => assert.equal(commandOf(chord(fields)), command));
}

test("Space and H do something as long as they are held, unless they are part of a chord", () => {
  assert.equal(heldBy(chord({ key: " " })), "pan");
  assert.equal(heldBy(chord({ key: "h" })), "hide");
  assert.equal(heldBy(chord({ key: "р", code: "KeyH" })), "hide");
  assert.equal(heldBy(chord({ key: "h", ctrlKey: true })), null);
  assert.equal(heldBy(chord({ key: "a" })), null);
});
