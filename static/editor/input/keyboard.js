/**
 * Listens to keys before viser's camera can hear them.
 *
 * @module
 */

import { isForThePage } from "./focus.js";
import { commandOf, heldBy } from "./keys.js";

/** A key that is let go sooner was not held. */
const TAP_MS = 500;

/**
 * @typedef {Object} Parts  of the editor that keys reach
 * @property {(command: string) => boolean} perform  false for a command that nobody knows
 * @property {import("../state/editor_state.js").EditorState} state
 * @property {import("./pointer.js").Pointer} pointer
 * @property {(held: boolean) => void} sweep  takes up the broom for as long as its key is held
 * @property {(at: number) => void} pressed  a key that runs a command, and when
 */

/** @type {(parts: Parts) => void} */
export function listenToKeys({ perform, state, pointer, sweep, pressed }) {
  const hold = (/** @type {string | null} */ what, /** @type {boolean} */ down) => {
    if (what === "pan") pointer.panKey = down;
    else if (what === "hide") state.layers.allHidden = down;
    else if (what === "broom") sweep(down && !pointer.pressed);
    else return false;
    pointer.cursor();
    state.signals.overlay.emit();
    return true;
  };
  /** When the key was pressed that pans while it is held. @type {number | null} */
  let tapped = null;
  const down = (/** @type {KeyboardEvent} */ event) => {
    if (isForThePage(event)) return false;
    const held = heldBy(event);
    if (held === "pan" && !event.repeat) tapped = event.timeStamp;
    if (hold(held, true)) return true;
    const command = commandOf(event);
    if (!command) return false;
    pressed(event.timeStamp);
    return perform(command);
  };
  // A key is let go wherever the focus has gone meanwhile, and whatever else is pressed.
  const up = (/** @type {KeyboardEvent} */ event) => {
    const { key, code, shiftKey, timeStamp } = event;
    const held = heldBy({ key, code, shiftKey, ctrlKey: false, metaKey: false, altKey: false });
    if (held === "pan" && tapped !== null && timeStamp - tapped < TAP_MS && !pointer.panned) {
      const command = commandOf(event);
      if (command) perform(command);
    }
    if (held === "pan") tapped = null;
    return hold(held, false);
  };
  listen("keydown", down);
  listen("keyup", up);
  window.addEventListener("blur", () => {
    pointer.panKey = state.layers.allHidden = false;
    sweep(false);
    state.signals.overlay.emit();
  });
}

/** @type {(type: "keydown" | "keyup", hear: (event: KeyboardEvent) => boolean) => void} */
function listen(type, hear) {
  window.addEventListener(
    type,
    (event) => {
      if (!hear(event)) return;
      event.preventDefault();
      event.stopImmediatePropagation();
    },
    { capture: true },
  );
}
