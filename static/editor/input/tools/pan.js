/** @typedef {import("../../state/desk.js").Desk} Desk */
/** @typedef {import("./tool.js").Tool} Tool */

/**
 * Moves the view.
 *
 * @param {Desk} desk
 * @returns {Tool}
 */
export function panTool(desk) {
  /** @type {import("../../protocol.js").Point} */
  let last = [0, 0];
  return {
    name: "pan",
    cursor: "grab",
    hover() {},
    down: (press) => (last = press.screen),
    drag(press) {
      desk.lens.panBy(press.screen[0] - last[0], press.screen[1] - last[1]);
      last = press.screen;
    },
    up() {},
    cancel: () => false,
  };
}
