/**
 * Listens to keys before viser's camera can hear them.
 *
 * @module
 */

import { commandOf, isTyping } from "./keys.js";

/**
 * @typedef {Object} Ears
 * @property {(command: string) => boolean} run
 * @property {import("../state/desk.js").Desk} desk
 * @property {import("./pointer.js").Pointer} pointer
 * @property {(at: number) => void} blame
 */

/** @type {(ears: Ears) => void} */
export function listenToKeys({ run, desk, pointer, blame }) {
  const held = (/** @type {KeyboardEvent} */ event, /** @type {boolean} */ down) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return false;
    if (event.key === " ") pointer.panKey = down;
    else if (event.key.toLowerCase() === "h") desk.hidden = down;
    else return false;
    pointer.cursor();
    desk.signals.overlay.emit();
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
    blame(event.timeStamp);
    return run(command);
  });
  listen("keyup", (event) => held(event, false));
  window.addEventListener("blur", () => {
    pointer.panKey = desk.hidden = false;
    desk.signals.overlay.emit();
  });
}
