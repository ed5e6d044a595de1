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

/**
 * The command of the character that is typed; where that is none's, of the one that stands there on a US
 * keyboard.
 *
 * @type {(chord: Chord) => string | null}
 */
export function commandOf(chord) {
  const typed = COMMANDS.get(nameOf(chord, chord.key));
  if (typed) return typed;
  const engraved = engravedOn(chord);
  return (engraved && COMMANDS.get(nameOf(chord, engraved))) ?? null;
}

/** What happens as long as the key is held: "pan", "hide" or nothing. @type {(chord: Chord) => string | null} */
export function heldBy(chord) {
  const { ctrlKey, metaKey, altKey } = chord;
  if (ctrlKey || metaKey || altKey) return null;
  return HELD.get(shortened(chord.key)) ?? HELD.get(shortened(engravedOn(chord) ?? "")) ?? null;
}

/** The chord as it stands in the key list, in small letters. @type {(chord: Chord, typed: string) => string} */
function nameOf(chord, typed) {
  const key = shortened(typed);
  const named = key.length > 1 || /[a-z←→↑↓]/.test(key);
  // AltGr, which some keyboards need for a bracket, is told as Ctrl and Alt, or as Alt.
  const signByAlt = !named && !/\d/.test(key) && chord.altKey;
  const ctrl = (chord.ctrlKey && !signByAlt) || chord.metaKey ? "ctrl+" : "";
  const alt = chord.altKey && !signByAlt ? "alt+" : "";
  // Whether a "?" takes Shift depends on the keyboard; a letter or an arrow with Shift is another chord.
  return `${ctrl}${alt}${chord.shiftKey && named ? "shift+" : ""}${key}`;
}

/** @type {(key: string) => string} */
function shortened(key) {
  const small = key.toLowerCase();
  return SHORT[small] ?? small;
}

/** What stands on keys of a US keyboard that are neither letters nor digits. @type {Record<string, string>} */
const SIGNS = { BracketLeft: "[", BracketRight: "]", Minus: "-", Equal: "=" };

/**
 * What is engraved on the key of a US keyboard at this place; null where the character that was typed is a
 * Latin letter or a digit, which means itself.
 *
 * @type {(chord: Chord) => string | null}
 */
function engravedOn({ key, code, shiftKey }) {
  // A dead key and a method of input name no character at all.
  if (/^[a-z0-9]$/i.test(key) || (key.length > 1 && !["Dead", "Process", "Unidentified"].includes(key)))
    return null;
  const [, letter] = /^Key([A-Z])$/.exec(code) ?? [];
  if (letter) return letter;
  const [, digit] = /^Digit(\d)$/.exec(code) ?? [];
  return shiftKey ? null : (digit ?? SIGNS[code] ?? null);
}
