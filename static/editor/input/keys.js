/**
 * Which command a key runs, and which key belongs to something else on the page.
 *
 * @module
 */

import DECLARED from "../commands.js";

/** What the key list calls keys whose names the browser spells out. @type {Record<string, string>} */
const SHORT = {
  escape: "esc",
  delete: "del",
  arrowleft: "←",
  arrowright: "→",
  arrowup: "↑",
  arrowdown: "↓",
  " ": "space",
};

/** What happens while a key is held, by key. @type {Map<string, string>} */
const HELD = new Map(DECLARED.held.map(({ name, key }) => [key.toLowerCase(), name]));

/** @type {Map<string, string>} */
const COMMANDS = new Map([
  ...DECLARED.groups
    .flatMap(({ commands }) => commands)
    .flatMap(({ name, keys }) => keys.map((key) => entry(key, name))),
  ...DECLARED.layers.map(({ name, key }) => entry(key, commandOfLayer(name))),
]);

/** @type {(key: string, command: string) => [string, string]} */
function entry(key, command) {
  return [key.toLowerCase(), command];
}

/** The command that shows or hides a layer. @type {(layer: string) => string} */
export function commandOfLayer(layer) {
  return `layer_${layer}`;
}

/** @typedef {Pick<KeyboardEvent, "key" | "code" | "ctrlKey" | "metaKey" | "altKey" | "shiftKey">} Chord */

/** @type {(chord: Chord) => string | null} */
export function commandOf(chord) {
  return COMMANDS.get(nameOf(chord)) ?? null;
}

/** What happens as long as the key is held: "pan", "hide" or nothing. @type {(chord: Chord) => string | null} */
export function heldBy(chord) {
  const { ctrlKey, metaKey, altKey } = chord;
  return ctrlKey || metaKey || altKey ? null : (HELD.get(shortened(latin(chord))) ?? null);
}

/** The chord as it stands in the key list, in small letters. @type {(chord: Chord) => string} */
function nameOf(chord) {
  const key = shortened(latin(chord));
  const named = key.length > 1 || /[a-z←→↑↓]/.test(key);
  const ctrl = chord.ctrlKey || chord.metaKey ? "ctrl+" : "";
  const alt = chord.altKey ? "alt+" : "";
  // Whether a "?" takes Shift depends on the keyboard; a letter or an arrow with Shift is another chord.
  return `${ctrl}${alt}${chord.shiftKey && named ? "shift+" : ""}${key}`;
}

/** @type {(key: string) => string} */
function shortened(key) {
  const small = key.toLowerCase();
  return SHORT[small] ?? small;
}

/**
 * The letter engraved on a Latin keyboard where the layout types another script.
 *
 * @type {(chord: Chord) => string}
 */
function latin({ key, code }) {
  const foreign = key.length === 1 && key.charCodeAt(0) > 127;
  return foreign && code.startsWith("Key") ? code.slice(3) : key;
}

/**
 * Whether the key belongs to what has the focus rather than to the editor.
 *
 * @param {KeyboardEvent} event
 * @returns {boolean}
 */
export function isTyping(event) {
  const target = event.target instanceof Element ? event.target : null;
  if (!target) return false;
  if (
    target.closest(
      "input, textarea, select, [contenteditable=''], [contenteditable=true], [role=dialog], dialog",
    )
  )
    return true;
  const walks =
    event.key.startsWith("Arrow") || event.key === "Tab" || event.key === " " || event.key === "Enter";
  return walks && target !== document.body && target.closest("#fairyring-editor") === null;
}
