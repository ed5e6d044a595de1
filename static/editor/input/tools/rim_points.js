/**
 * A cap by points of its rim: a circle through three, an ellipse by five and more. It is put down by Enter, a
 * double click, or when another tool is taken up.
 *
 * @module
 */

import { hundredths, rounded } from "../../geometry/caps.js";
import { circleBy, ellipseBy } from "../../geometry/fits.js";
import { toScreen } from "../../geometry/view.js";
import { COLOURS } from "../../render/palette.js";
import { drawPlaced, place } from "./placing.js";
import { CLICK_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../protocol.js").Whole} Whole */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** @implements {Tool} */
export class RimPointsTool {
  name = "rim_points";
  cursor = "crosshair";
  /** @type {Point[]} */
  #points = [];
  /** The last point is being dragged to its place. */
  #pressed = false;
  #state;

  /** @param {EditorState} state */
  constructor(state) {
    this.#state = state;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    const item = this.#points.length ? null : this.#state.at(press.image, 0);
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#pressed = true;
    const last = this.#points.at(-1);
    const { view } = this.#state.viewport;
    // The second press of a double click means the point that is there.
    if (last && apart(toScreen(view, ...last), press.screen) <= CLICK_PX) return;
    this.#points.push([0, 0]);
    this.drag(press);
  }

  /** @type {(press: Press) => void} */
  drag({ image: [x, y] }) {
    if (this.#pressed) this.#points = [...this.#points.slice(0, -1), [hundredths(x), hundredths(y)]];
    this.#state.signals.overlay.emit();
  }

  up() {
    this.#pressed = false;
  }

  double() {
    this.finish();
  }

  /** What the points tell so far. @returns {Whole | null} */
  get #whole() {
    const whole = ellipseBy(this.#points) ?? circleBy(this.#points);
    return whole && rounded(whole);
  }

  finish() {
    const whole = this.#whole;
    const busy = this.#points.length > 0;
    if (whole) {
      this.cancel();
      place(this.#state, whole);
    }
    return busy;
  }

  leave() {
    this.finish();
    this.cancel();
  }

  cancel() {
    const busy = this.#points.length > 0;
    this.#points = [];
    this.#pressed = false;
    this.#state.signals.overlay.emit();
    return busy;
  }

  back() {
    return this.undo();
  }

  undo() {
    const had = this.#points.length > 0;
    this.#points = this.#points.slice(0, -1);
    this.#pressed = false;
    this.#state.signals.overlay.emit();
    return had;
  }

  redo() {
    return this.#points.length > 0;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const whole = this.#whole;
    if (whole) drawPlaced(context, this.#state, whole);
    context.beginPath();
    for (const point of this.#points) {
      const [x, y] = toScreen(view, ...point);
      context.rect(x - 3, y - 3, 6, 6);
    }
    context.fillStyle = COLOURS.draft;
    context.fill();
    return this.#points.length > 0;
  };
}
