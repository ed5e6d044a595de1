/**
 * Listens to keys before viser's camera can hear them.
 *
 * @module
 */

import { commandOf, heldBy, isTyping } from "./keys.js";

/**
 * @typedef {Object} Parts  of the editor that keys reach
 * @property {(command: string) => boolean} perform  false for a command that nobody knows
 * @property {import("../state/editor_state.js").EditorState} state
 * @property {import("./pointer.js").Pointer} pointer
 * @property {(at: number) => void} pressed  a key that runs a command, and when
 */

/** @type {(parts: Parts) => void} */
export function listenToKeys({ perform, state, pointer, pressed }) {
  const held = (/** @type {KeyboardEvent} */ event, /** @type {boolean} */ down) => {
    const what = heldBy(event);
    if (what === "pan") pointer.panKey = down;
    else if (what === "hide") state.layers.allHidden = down;
    else return false;
    pointer.cursor();
    state.signals.overlay.emit();
    return true;
  };
  const listen = (
    /** @type {"keydown" | "keyup"} */ type,
    /** @type {(event: KeyboardEvent) => boolean} */ hear,
  ) => {
    window.addEventListener(
      type,
      (event) => {
        if (isTyping(event) || !hear(event)) return;
        event.preventDefault();
        event.stopImmediatePropagation();
      },
      { capture: true },
    );
  };
  listen("keydown", (event) => {
    if (held(event, true)) return true;
    const command = commandOf(event);
    if (!command) return false;
    pressed(event.timeStamp);
    return perform(command);
  });
  listen("keyup", (event) => held(event, false));
  window.addEventListener("blur", () => {
    pointer.panKey = state.layers.allHidden = false;
    state.signals.overlay.emit();
  });
}
