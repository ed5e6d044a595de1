/**
 * The keys, once: what they do and what the key list says about them.
 *
 * @module
 */

/** @typedef {{keys: string[], command: string, text: string}} Binding */

/** @type {[string, Binding[]][]} */
export const KEYS = [
  [
    "Tools",
    [
      bind("v", "select", "Select and edit"),
      bind("w", "polygon", "Draw a visible outline"),
      bind("c", "circle", "Drag out a circle from its centre"),
      bind("g", "pan", "Move the view"),
      bind("Enter", "finish", "Close the outline being drawn"),
      bind("Escape", "cancel", "Drop what is half done, then deselect"),
      bind(
        "Delete Backspace",
        "delete",
        "Delete the vertex under the pointer, else the selected caps; take back a point",
      ),
    ],
  ],
  [
    "Caps",
    [
      bind("Tab", "next_cap", "Next cap"),
      bind("Shift+Tab", "previous_cap", "Previous cap"),
      bind("Ctrl+A", "select_all", "Select all"),
      bind("a", "accept", "Accept the selected prediction"),
      bind("Shift+A", "accept_all", "Accept all open predictions"),
      bind("m", "mark", "Take the outline as mark, or clear the mark"),
      bind("x", "convert", "Circle to polygon mark and back, same centre"),
      bind("d", "doubtful", "Doubtful"),
      bind("i", "ignored", "Ignored"),
      bind("[", "lower", "Lower in the overlap order"),
      bind("]", "raise", "Higher in the overlap order"),
      bind("ArrowLeft", "nudge_left", ""),
      bind("ArrowRight", "nudge_right", ""),
      bind("ArrowUp", "nudge_up", ""),
      bind("ArrowDown", "nudge_down", "Move by a quarter of a pixel"),
      bind("Shift+ArrowLeft", "push_left", ""),
      bind("Shift+ArrowRight", "push_right", ""),
      bind("Shift+ArrowUp", "push_up", ""),
      bind("Shift+ArrowDown", "push_down", "Move by a pixel"),
      bind("Ctrl+Z", "undo", "Undo"),
      bind("Ctrl+Shift+Z Ctrl+Y", "redo", "Redo"),
    ],
  ],
  [
    "Image",
    [
      bind("n PageDown", "next_image", "Next image"),
      bind("p PageUp", "previous_image", "Previous image"),
      bind("Ctrl+Enter", "done", "Mark as annotated and go to the next"),
      bind("f", "fit", "Fit the photo"),
      bind("z", "zoom_selection", "Zoom to the selection"),
      bind("+ =", "zoom_in", "Zoom in"),
      bind("-", "zoom_out", "Zoom out"),
      bind("1", "layer_photo", "Photo"),
      bind("2", "layer_outline", "Visible outlines"),
      bind("3", "layer_fill", "Fill"),
      bind("4", "layer_whole", "Whole outlines"),
      bind("5", "layer_centre", "Centres"),
      bind("6", "layer_label", "Labels"),
      bind("7", "layer_prediction", "Predictions"),
      bind("?", "help", "This list"),
    ],
  ],
];

/** What a pointer does, for the key list. @type {[string, string][]} */
export const GESTURES = [
  ["Wheel", "Zoom to the pointer"],
  ["Drag the ground · Space, middle or right drag", "Move the view"],
  ["Click · Shift-click · Shift-drag", "Select · add · select all inside"],
  ["Double click", "Zoom to the cap"],
  ["Drag a vertex", "Move it; a dense outline follows (Alt: this vertex only)"],
  ["Drag an edge", "Put a vertex in"],
  ["Alt-click a vertex", "Take it out"],
  ["Hold H", "Hide all shapes"],
];

/** @type {(keys: string, command: string, text: string) => Binding} */
function bind(keys, command, text) {
  return { keys: keys.split(" "), command, text };
}

const COMMAND_OF = new Map(
  KEYS.flatMap(([, bindings]) =>
    bindings.flatMap(({ keys, command }) => keys.map((key) => [key.toLowerCase(), command])),
  ),
);

/** @type {(event: KeyboardEvent) => string | null} */
export function commandOf(event) {
  return COMMAND_OF.get(chordOf(event)) ?? null;
}

/** @type {(event: KeyboardEvent) => string} */
function chordOf(event) {
  const key = latin(event).toLowerCase();
  const named = key.length > 1 || /[a-z]/.test(key);
  const ctrl = event.ctrlKey || event.metaKey ? "ctrl+" : "";
  const alt = event.altKey ? "alt+" : "";
  return `${ctrl}${alt}${event.shiftKey && named ? "shift+" : ""}${key}`;
}

/**
 * The letter engraved on a Latin keyboard where the layout types another script.
 *
 * @type {(event: KeyboardEvent) => string}
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
