/**
 * Draws the visible outline of a new cap: click points, or drag to draw freehand. What is half drawn is kept
 * apart from the tool (`state/half_drawn.js`), so that taking up another tool loses nothing.
 *
 * @module
 */

import { hundredths, newCap } from "../../geometry/caps.js";
import { newShape } from "../../geometry/shapes.js";
import { comesRound } from "../../geometry/strokes.js";
import { FEWEST } from "../../geometry/vertices.js";
import { toScreen } from "../../geometry/view.js";
import { newId } from "../../ids.js";
import { drawHalfDrawn } from "../../render/half_drawn.js";
import { CLICK_PX, GRAB_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

const FREEHAND_PX = 7;
/** How far a double click may wander and still mean one point. */
const DOUBLE_PX = 8;
/** A held Ctrl+Z stops at the first point: so soon after it, it is not meant for what was done before. */
const STOPS_MS = 600;

/** @implements {Tool} */
export class PolygonTool {
  name = "polygon";
  cursor = "crosshair";
  /** @type {Point | null} */
  #next = null;
  #closing = false;
  /** Points that were there before the press; null while nothing is pressed. @type {number | null} */
  #before = null;
  /** Whether the last press placed a point. */
  #placed = false;
  /** When the last point was taken back. */
  #emptied = -Infinity;
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

  get #drawn() {
    return this.#state.halfDrawn;
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
    return this.#drawn.points.length >= FEWEST && this.#fromPoint(0, press) <= GRAB_PX;
  }

  /**
   * CSS pixels from a point that is drawn; infinitely many where there is none.
   *
   * @type {(index: number, press: Press) => number}
   */
  #fromPoint(index, press) {
    const point = this.#drawn.points.at(index);
    return point ? apart(toScreen(this.#state.viewport.view, ...point), press.screen) : Infinity;
  }

  /** @type {(press: Press) => void} */
  down(press) {
    const drawn = this.#drawn;
    if (drawn.empty) this.#state.select([]);
    this.#before = drawn.points.length;
    // The second press of a double click, or a hand that shakes, means the point that is there.
    this.#placed = this.#fromPoint(-1, press) > CLICK_PX;
    if (this.#closes(press)) this.finish();
    else if (this.#placed) this.#add(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    this.#next = press.image;
    if (this.#fromPoint(-1, press) >= FREEHAND_PX) this.#add(press);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  #add({ image: [x, y] }) {
    const { width, height } = this.#state.image ?? { width: 0, height: 0 };
    this.#drawn.add([
      hundredths(Math.min(width, Math.max(0, x))),
      hundredths(Math.min(height, Math.max(0, y))),
    ]);
  }

  /**
   * Letting go near the start of a freehand outline, or after running on beyond it, closes it.
   *
   * @type {(press: Press) => void}
   */
  up(press) {
    const before = this.#before;
    this.#before = null;
    const { points } = this.#drawn;
    if (before === null || points.length - before <= 2 * FEWEST) return;
    const reach = GRAB_PX / this.#state.viewport.view.scale;
    if (this.#closes(press) || comesRound(points, reach)) this.finish();
  }

  /** The second press of a double click may have shaken farther than a single one may. @type {() => void} */
  double() {
    const { points } = this.#drawn;
    const { view } = this.#state.viewport;
    const [last, before] = [points.at(-1), points.at(-2)];
    const far = last && before ? apart(toScreen(view, ...last), toScreen(view, ...before)) : Infinity;
    if (this.#placed && far <= DOUBLE_PX) this.#drawn.begin(points.slice(0, -1));
    this.finish();
  }

  finish() {
    const { points } = this.#drawn;
    if (points.length === 0) return false;
    if (points.length < FEWEST) return true;
    const after = newShape(newId(), newCap({ visible: [points.flat()] }));
    this.#before = null;
    this.#drawn.begin([]);
    this.#state.commit([{ before: null, after }]);
    this.#state.select([after.uid]);
    this.#state.signals.draft.emit(after);
    this.#done();
    return true;
  }

  back() {
    return !this.#drawn.empty && this.#drawn.undo();
  }

  undo() {
    const had = this.#drawn.undo();
    if (had && this.#drawn.empty) this.#emptied = performance.now();
    return had || performance.now() - this.#emptied < STOPS_MS;
  }

  redo() {
    return this.#drawn.redo() || !this.#drawn.empty;
  }

  cancel() {
    const busy = !this.#drawn.empty;
    this.#drawn.drop();
    this.#before = this.#next = null;
    this.#state.signals.overlay.emit();
    return busy;
  }

  leave() {
    if (this.#drawn.empty) this.#drawn.begin([]);
    this.#before = this.#next = null;
    this.#state.signals.overlay.emit();
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const { points } = this.#drawn;
    if (points.length === 0) return false;
    const next = this.#next ?? points[points.length - 1];
    drawHalfDrawn(context, view, { points, next, closing: this.#closing });
    return true;
  };

  /** The same while another tool is in hand. @type {import("../../render/overlay.js").Sketch} */
  resting = (context, view) => {
    const { points } = this.#drawn;
    if (points.length) drawHalfDrawn(context, view, { points, next: null, closing: false });
    return points.length > 0;
  };
}
