import { toScreen } from "../../../static/editor/geometry/view.js";
import { IMAGE } from "./state.js";

/** @typedef {import("../../../static/editor/protocol.js").Point} Point */
/** @typedef {import("../../../static/editor/state/editor_state.js").EditorState} EditorState */
/** @typedef {import("../../../static/editor/input/tools/tool.js").Press} Press */
/** @typedef {import("../../../static/editor/input/tools/tool.js").Tool} Tool */
/** @typedef {{alt?: boolean, shift?: boolean, ctrl?: boolean}} Held */

/**
 * A hand that uses a tool, at points of the image; the window shows it pixel by pixel.
 *
 * @param {EditorState} state
 * @param {Tool} tool
 */
export function handOf(state, tool) {
  state.viewport.resize({ width: IMAGE.width + 24, height: IMAGE.height + 24 });
  const press = (
    /** @type {Point} */ image,
    /** @type {Held} */ { alt = false, shift = false, ctrl = false } = {},
  ) => {
    return { screen: toScreen(state.viewport.view, ...image), image, alt, shift, ctrl, time: performance.now() };
  };
  const hand = {
    hover: (/** @type {Point} */ at, /** @type {Held} */ held = {}) => tool.hover(press(at, held)),
    down: (/** @type {Point} */ at, /** @type {Held} */ held = {}) => tool.down(press(at, held)),
    drag: (/** @type {Point[]} */ ...way) => way.forEach((at) => tool.drag(press(at))),
    up: (/** @type {Point} */ at, /** @type {Held} */ held = {}) => tool.up(press(at, held)),
    click(/** @type {Point} */ at, /** @type {Held} */ held = {}) {
      hand.hover(at);
      hand.down(at, held);
      hand.up(at, held);
    },
    /** Presses at the first point, and lets go at the last. */
    stroke(/** @type {Point[]} */ way, /** @type {Held} */ held = {}) {
      hand.down(way[0], held);
      hand.drag(...way.slice(1));
      hand.up(way[way.length - 1], held);
    },
    double: (/** @type {Point} */ at) => tool.double?.(press(at)),
  };
  return hand;
}
