/**
 * Sweeps false caps away: what the pointer runs over while the key is held is deleted when the key is let go, as
 * one step. Esc lets all of it lie.
 *
 * @module
 */

import { toScreen } from "../../geometry/view.js";
import { CASING, COLOURS } from "../../render/palette.js";
import { strokeCased, traceCap } from "../../render/paths.js";
import { deleteShapes } from "../../state/edits.js";
import { apart } from "./tool.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** A quick pointer tells where it is so seldom that whole caps lie between: it is looked for so often, CSS pixels. */
const STEP_PX = 4;

/** @implements {Tool} */
export class Broom {
  name = "broom";
  cursor = "cell";
  /** @type {Set<string>} */
  #swept = new Set();
  /** @type {Point | null} */
  #last = null;
  #state;

  /** @param {EditorState} state */
  constructor(state) {
    this.#state = state;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { view } = this.#state.viewport;
    const from = this.#last ?? press.image;
    const steps = Math.max(1, Math.ceil(apart(toScreen(view, ...from), press.screen) / STEP_PX));
    for (let i = 1; i <= steps; i++) {
      const [x, y] = [0, 1].map((k) => from[k] + ((press.image[k] - from[k]) * i) / steps);
      const shape = this.#state.at([x, y], 0);
      if (shape) this.#swept.add(shape.uid);
    }
    this.#last = press.image;
    this.#state.selection.hover(null);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.hover(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    this.hover(press);
  }

  up() {}

  leave() {
    const shapes = this.#shapes;
    this.cancel();
    if (shapes.length === 0) return;
    this.#state.select([]);
    deleteShapes(this.#state, shapes);
  }

  cancel() {
    const busy = this.#swept.size > 0;
    this.#swept = new Set();
    this.#last = null;
    this.#state.signals.overlay.emit();
    return busy;
  }

  undo() {
    return this.cancel();
  }

  get #shapes() {
    return [...this.#swept].flatMap((uid) => this.#state.items.get(uid) ?? []);
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    context.beginPath();
    for (const { cap } of this.#shapes) traceCap(context, view, cap);
    context.fillStyle = "rgba(255, 92, 108, 0.35)";
    context.fill();
    context.setLineDash([3, 3]);
    strokeCased(context, { colour: COLOURS.refused, width: 2, casing: CASING });
    context.setLineDash([]);
    return this.#swept.size > 0;
  };
}
