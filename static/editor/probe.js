/**
 * `window.fairyring`: what tests and the bench may look at. Nothing in the editor reads it.
 *
 * @module
 */

import { isPrediction } from "./state/store.js";
import { toImage, toScreen } from "./geometry/view.js";

/** @typedef {import("./state/desk.js").Desk} Desk */
/** @typedef {import("./render/frame.js").Frame} Frame */

/**
 * @param {HTMLElement} host
 * @param {{desk: Desk, frame: Frame, waiting: () => number, connection: () => string, tool: () => string}} editor
 */
export function expose(host, { desk, frame, waiting, connection, tool }) {
  const view = {
    /**
     * Page coordinates of an image point, ready for a mouse.
     *
     * @type {(x: number, y: number) => {x: number, y: number}}
     */
    toScreen(x, y) {
      const box = host.getBoundingClientRect();
      const [sx, sy] = toScreen(desk.lens.view, x, y);
      return { x: sx + box.left, y: sy + box.top };
    },
    /** @type {(x: number, y: number) => {x: number, y: number}} */
    toImage(x, y) {
      const box = host.getBoundingClientRect();
      const [ix, iy] = toImage(desk.lens.view, x - box.left, y - box.top);
      return { x: ix, y: iy };
    },
    get scale() {
      return desk.lens.view.scale;
    },
  };
  const state = {
    get selection() {
      return [...desk.selected];
    },
    /** Caps people agreed on, as they look now. */
    get shapes() {
      return desk.items
        .filter((shape) => !isPrediction(shape))
        .map((shape) => desk.drafts.get(shape.uid) ?? shape);
    },
    get predictions() {
      return desk.items.filter(isPrediction);
    },
    get image() {
      return desk.image;
    },
    /** How the outline of the one selected cap came about. */
    get fit() {
      return desk.explanation;
    },
    get waiting() {
      return waiting();
    },
    get connection() {
      return connection();
    },
    get tool() {
      return tool();
    },
  };
  Object.assign(window, { fairyring: { view, state, timings: frame.timings } });
}
