/**
 * Drags a circle out from its centre: the mark of the selected cap where it lies around what is seen of that,
 * else a new cap. Which of the two it will be is written beside it.
 *
 * @module
 */

import { hundredths, placedWhole } from "../../geometry/caps.js";
import { SMALLEST_RADIUS, movedHandle, shownHandle } from "../../geometry/handles.js";
import { withCap } from "../../geometry/shapes.js";
import { drawPlaced, newCapBy, place } from "./placing.js";
import { CLICK_PX, apart } from "./tool.js";

/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Circle} Circle */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** A press beside a handle, and not on it, begins another circle: of a bud that touches this one. */
const HANDLE_PX = 5;

/** @implements {Tool} */
export class CircleTool {
  name = "circle";
  cursor = "crosshair";
  /** @type {Press | null} */
  #start = null;
  /** @type {Circle | null} */
  #circle = null;
  /** The circle of the selected cap, taken by a handle. @type {{shape: Shape, handle: Handle} | null} */
  #grip = null;
  /** The circle that was taken has moved. */
  #moved = false;
  #state;

  /** @param {EditorState} state */
  constructor(state) {
    this.#state = state;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    const item = this.#state.at(press.image, 0);
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
    this.cursor = this.#handleAt(press) ? "move" : "crosshair";
  }

  /** @type {(press: Press) => {shape: Shape, handle: Handle} | null} */
  #handleAt(press) {
    const { sole: shape, viewport } = this.#state;
    const placed = shape && placedWhole(shape.cap);
    if (!shape || placed?.kind !== "circle") return null;
    const handle = shownHandle(placed, press.image, HANDLE_PX / viewport.view.scale);
    return handle && { shape, handle };
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#state.commitDrafts();
    this.#start = press;
    this.#grip = this.#handleAt(press);
    this.#moved = false;
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    const start = this.#start;
    if (!start || (!this.#circle && apart(press.screen, start.screen) < CLICK_PX)) return;
    const dx = hundredths(press.image[0] - start.image[0]);
    const dy = hundredths(press.image[1] - start.image[1]);
    if (this.#grip) {
      const { shape, handle } = this.#grip;
      // Something else, a key, has committed or taken back what is being dragged.
      if (this.#moved && !this.#state.drafts.has(shape.uid)) {
        this.#start = this.#grip = null;
        return;
      }
      this.#moved = true;
      const cap = movedHandle(shape.cap, handle, { dx, dy, from: start.image, pull: 0 });
      this.#state.propose([withCap(shape, cap)]);
      return;
    }
    const [cx, cy] = start.image.map(hundredths);
    this.#circle = { kind: "circle", cx, cy, r: Math.max(SMALLEST_RADIUS, hundredths(Math.hypot(dx, dy))) };
    this.#state.signals.drawing.emit(newCapBy(this.#state, this.#circle));
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    if (!this.#start) return;
    if (this.#grip || this.#circle) return this.leave();
    this.#start = null;
    const item = this.#state.at(press.image, 0);
    this.#state.select(item ? [item.uid] : []);
  }

  /** Ends the drag as letting go would. */
  leave() {
    const circle = this.#circle;
    this.#start = this.#circle = this.#grip = null;
    this.#state.commitDrafts();
    this.#state.signals.drawing.emit(null);
    if (circle) place(this.#state, circle);
    this.#state.signals.overlay.emit();
  }

  cancel() {
    const busy = this.#circle !== null || this.#grip !== null;
    this.#start = this.#circle = this.#grip = null;
    this.#state.withdraw();
    this.#state.signals.drawing.emit(null);
    this.#state.signals.overlay.emit();
    return busy;
  }

  /** While the pointer is pressed, what it drags is all that is taken back. */
  undo() {
    const pressed = this.#start !== null;
    if (pressed) this.cancel();
    return pressed;
  }

  redo() {
    return this.#start !== null;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context) => {
    if (this.#circle) drawPlaced(context, this.#state, this.#circle);
    return this.#circle !== null;
  };
}
