/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Tool} Tool */

/**
 * Moves the view.
 *
 * @param {EditorState} state
 * @returns {Tool}
 */
export function panTool({ viewport }) {
  /** @type {import("../../protocol.js").Point} */
  let last = [0, 0];
  return {
    name: "pan",
    cursor: "grab",
    hover() {},
    down: (press) => (last = press.screen),
    drag(press) {
      viewport.panBy(press.screen[0] - last[0], press.screen[1] - last[1]);
      last = press.screen;
    },
    up() {},
    cancel: () => false,
    leave() {},
  };
}
