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

/**
 * What the browser tells of a key.
 *
 * @type {(fields: Partial<import("../../../static/editor/input/keys.js").Chord>) => import("../../../static/editor/input/keys.js").Chord}
 */
const chord = (fields) => {
  return { key: "", code: "", ctrlKey: false, metaKey: false, altKey: false, shiftKey: false, ...fields };
};

test("every command that is declared has an action, and every action is declared once", () => {
  assert.deepEqual(Object.keys(ACTIONS).sort(), NAMES.sort());
});

test("no key runs two commands; the space bar, which is held to pan, runs one where it is let go at once", () => {
  const keys = [
    ...COMMANDS.flatMap((command) => command.keys),
    ...DECLARED.layers.map(({ key }) => key),
    ...DECLARED.held.map(({ key }) => key),
  ].map((key) => key.toLowerCase());
  assert.deepEqual(
    keys.filter((key, i) => keys.indexOf(key) !== i),
    ["space"],
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
  ["Ctrl+Z where the layout types Cyrillic", { key: "я", code: "KeyZ", ctrlKey: true }, "undo"],
  ["Shift+A where the layout types Greek", { key: "Α", code: "KeyA", shiftKey: true }, "accept_all"],
  ["a letter while an input method is on", { key: "Process", code: "KeyW" }, "polygon"],
  ["the key of [ on a Russian keyboard", { key: "х", code: "BracketLeft" }, "lower"],
  ["the key of ] on a Russian keyboard", { key: "ъ", code: "BracketRight" }, "raise"],
  ["the key of [ on a German keyboard", { key: "ü", code: "BracketLeft" }, "lower"],
  ["+ on a German keyboard, where ] would be", { key: "+", code: "BracketRight" }, "zoom_in"],
  ["] by AltGr on Windows", { key: "]", code: "Digit9", ctrlKey: true, altKey: true }, "raise"],
  ["[ by AltGr on Linux", { key: "[", code: "Digit8" }, "lower"],
  ["[ by Option on a Mac", { key: "[", code: "Digit5", altKey: true }, "lower"],
  ["the dead key where [ would be on a French keyboard", { key: "Dead", code: "BracketLeft" }, "lower"],
  ["the key of ] on a French keyboard", { key: "$", code: "BracketRight" }, "raise"],
  ["the dead key where ] would be on a Nordic keyboard", { key: "Dead", code: "BracketRight" }, "raise"],
  ["a French key of a digit without Shift", { key: "&", code: "Digit1" }, "layer_photo"],
  ["a French key of a digit with Shift", { key: "1", code: "Digit1", shiftKey: true }, "layer_photo"],
  ["a digit of the keypad", { key: "7", code: "Numpad7" }, "layer_prediction"],
  ["Alt+ArrowUp, for keyboards without ]", { key: "ArrowUp", altKey: true }, "raise"],
  ["L on a Dvorak keyboard, where P would be", { key: "l", code: "KeyP" }, "arcs"],
  ["{, which is Shift and the key of [", { key: "{", code: "BracketLeft", shiftKey: true }, null],
  ["F5, which is the browser's", { key: "F5", code: "F5" }, null],
  ["Ctrl+Alt+Z, which is nobody's", { key: "z", ctrlKey: true, altKey: true }, null],
  ["Shift+M", { key: "M", code: "KeyM", shiftKey: true }, "unmark"],
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

test("every tool says what it does while it is in hand", () => {
  const hints = COMMANDS.filter((command) => "hint" in command).map(({ name }) => name);
  assert.deepEqual(
    hints.sort(),
    ["arcs", "circle", "pan", "point", "polygon", "rim", "rim_points", "select", "split"],
  );
});
