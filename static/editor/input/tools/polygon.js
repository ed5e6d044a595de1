/**
 * Draws the visible outline of a new cap: click points, or drag to draw freehand.
 *
 * @module
 */

import { hundredths, newCap } from "../../geometry/caps.js";
import { newShape } from "../../geometry/shapes.js";
import { FEWEST } from "../../geometry/vertices.js";
import { toScreen } from "../../geometry/view.js";
import { newId } from "../../ids.js";
import { CASING, COLOURS, FILLS } from "../../render/palette.js";
import { strokeCased, traceRing } from "../../render/paths.js";
import { GRAB_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

const FREEHAND_PX = 7;

/** @implements {Tool} */
export class PolygonTool {
  name = "polygon";
  cursor = "crosshair";
  /** @type {Point[]} */
  #points = [];
  /** @type {Point | null} */
  #next = null;
  #closing = false;
  #state;
  #done;

  /**
   * @param {EditorState} state
   * @param {() => void} done  a cap was drawn
   */
  constructor(state, done) {
    this.#state = state;
    this.#done = done;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    this.#next = press.image;
    this.#closing = this.#closes(press);
    this.cursor = this.#closing ? "pointer" : "crosshair";
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => boolean} */
  #closes(press) {
    if (this.#points.length < FEWEST) return false;
    return apart(toScreen(this.#state.viewport.view, ...this.#points[0]), press.screen) <= GRAB_PX;
  }

  /** @type {(press: Press) => void} */
  down(press) {
    if (this.#points.length === 0) this.#state.select([]);
    if (this.#closes(press)) this.finish();
    else this.#add(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    this.#next = press.image;
    const last = this.#points.at(-1);
    if (last && apart(toScreen(this.#state.viewport.view, ...last), press.screen) >= FREEHAND_PX)
      this.#add(press);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  #add({ image: [x, y] }) {
    const { width, height } = this.#state.image ?? { width: 0, height: 0 };
    const at = /** @type {Point} */ ([
      hundredths(Math.min(width, Math.max(0, x))),
      hundredths(Math.min(height, Math.max(0, y))),
    ]);
    const last = this.#points.at(-1);
    if (!last || last[0] !== at[0] || last[1] !== at[1]) this.#points.push(at);
    this.#state.signals.overlay.emit();
  }

  /** Letting go near the start of a freehand outline closes it. @type {(press: Press) => void} */
  up(press) {
    if (this.#points.length > 2 * FEWEST && this.#closes(press)) this.finish();
  }

  double() {
    this.finish();
  }

  finish() {
    if (this.#points.length === 0) return false;
    if (this.#points.length < FEWEST) return true;
    const after = newShape(newId(), newCap({ visible: [this.#points.flat()] }));
    this.#points = [];
    this.#state.commit([{ before: null, after }]);
    this.#state.select([after.uid]);
    this.#state.signals.draft.emit(after);
    this.#done();
    return true;
  }

  back() {
    const had = this.#points.pop() !== undefined;
    this.#state.signals.overlay.emit();
    return had;
  }

  cancel() {
    const busy = this.#points.length > 0;
    this.#points = [];
    this.#next = null;
    this.#state.signals.overlay.emit();
    return busy;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    if (this.#points.length === 0) return false;
    const points = this.#next
      ? [...this.#points, this.#closing ? this.#points[0] : this.#next]
      : this.#points;
    context.beginPath();
    traceRing(context, view, points.flat(), false);
    context.fillStyle = FILLS.selected;
    context.fill();
    strokeCased(context, { colour: COLOURS.draft, width: 2, casing: CASING });
    context.beginPath();
    for (const [i, point] of this.#points.entries()) {
      const [x, y] = toScreen(view, ...point);
      const half = i === 0 ? 4 : 2.5;
      context.rect(x - half, y - half, 2 * half, 2 * half);
    }
    context.fillStyle = this.#closing ? COLOURS.whole : COLOURS.draft;
    context.fill();
    context.strokeStyle = "#0b1220";
    context.lineWidth = 1;
    context.stroke();
    return true;
  };
}
