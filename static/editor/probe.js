/**
 * `window.fairyring`: what tests and the bench may look at. Nothing in the editor reads it.
 *
 * @module
 */

import { isPrediction } from "./geometry/shapes.js";
import { toImage, toScreen } from "./geometry/view.js";

/** @typedef {import("./render/frame.js").Frame} Frame */
/** @typedef {import("./state/editor_state.js").EditorState} EditorState */

/**
 * @param {HTMLElement} host
 * @param {{state: EditorState, frame: Frame, suggestion: () => unknown, waiting: () => number, asking: () => boolean, connection: () => string, tool: () => string, review: import("./state/review.js").Review}} editor
 */
export function expose(host, { state: editorState, frame, suggestion, waiting, asking, connection, tool, review }) {
  const { viewport } = editorState;
  const view = {
    /**
     * Page coordinates of an image point, ready for a mouse.
     *
     * @type {(x: number, y: number) => {x: number, y: number}}
     */
    toScreen(x, y) {
      const box = host.getBoundingClientRect();
      const [sx, sy] = toScreen(viewport.view, x, y);
      return { x: sx + box.left, y: sy + box.top };
    },
    /** @type {(x: number, y: number) => {x: number, y: number}} */
    toImage(x, y) {
      const box = host.getBoundingClientRect();
      const [ix, iy] = toImage(viewport.view, x - box.left, y - box.top);
      return { x: ix, y: iy };
    },
    get scale() {
      return viewport.view.scale;
    },
  };
  const state = {
    get selection() {
      return [...editorState.selection.uids];
    },
    /** What the pointer is on, as far as the tool in hand means it. */
    get hovered() {
      return editorState.selection.hovered;
    },
    /** Caps people agreed on, as they look now. */
    get shapes() {
      return editorState.items.all
        .filter((shape) => !isPrediction(shape))
        .map((shape) => editorState.shape(shape.uid));
    },
    get predictions() {
      return editorState.items.all.filter(isPrediction);
    },
    get image() {
      return editorState.image;
    },
    /** How the outline of the one selected cap came about. */
    get fit() {
      return editorState.explanation;
    },
    /** The one selected cap, or the one that is being drawn out, as it is offered to be. */
    get suggestion() {
      return suggestion();
    },
    get waiting() {
      return waiting();
    },
    /** Whether an answer of the network is waited for. */
    get asking() {
      return asking();
    },
    get connection() {
      return connection();
    },
    /** What a reviewer looks at. */
    get review() {
      const { on, image, caps, times, turn } = review;
      return { on, image, caps, times, turn };
    },
    get tool() {
      return tool();
    },
  };
  /** Calls back once all that is known is drawn. @type {(then: () => void) => void} */
  const whenDrawn = (then) => frame.whenComplete(then);
  Object.assign(window, { fairyring: { view, state, timings: frame.timings, whenDrawn } });
}
