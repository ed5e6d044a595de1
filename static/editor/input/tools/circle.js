/**
 * Drags a circle out from its centre: the mark of the selected cap when the press is inside it, else a
 * new cap of which nothing but the circle is known.
 *
 * @module
 */

import { hundredths, insideCap, newCap, placedWhole } from "../../geometry/caps.js";
import { SMALLEST_RADIUS, movedHandle, nearestHandle } from "../../geometry/handles.js";
import { pick } from "../../geometry/hit.js";
import { CASING, COLOURS, FILLS } from "../../render/palette.js";
import { strokeCased, traceCross, traceWhole } from "../../render/paths.js";
import { changed, withCap } from "../../geometry/shapes.js";
import { newId } from "../../sync/outbox_owner.js";
import { toScreen } from "../../geometry/view.js";
import { CLICK_PX, GRAB_PX, apart } from "./tool.js";

/** @typedef {import("../../state/desk.js").Desk} Desk */
/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../protocol.js").Circle} Circle */
/** @typedef {import("../../state/store.js").Shape} Shape */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

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
  #desk;

  /** @param {Desk} desk */
  constructor(desk) {
    this.#desk = desk;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const item = pick(this.#desk.pickable, press.image, 0);
    this.#desk.hover(item && !this.#desk.selected.has(item.uid) ? item.uid : null);
    this.cursor = this.#handleAt(press) ? "move" : "crosshair";
  }

  /** @type {(press: Press) => {shape: Shape, handle: Handle} | null} */
  #handleAt(press) {
    const shape = this.#desk.sole;
    if (!shape || placedWhole(shape.cap)?.kind !== "circle") return null;
    const bare = { ...shape.cap, visible: [] };
    const handle = nearestHandle(bare, press.image, GRAB_PX / this.#desk.lens.view.scale);
    return handle && { shape, handle };
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#desk.settle();
    this.#start = press;
    this.#grip = this.#handleAt(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    const start = this.#start;
    if (!start || (!this.#circle && apart(press.screen, start.screen) < CLICK_PX)) return;
    const dx = hundredths(press.image[0] - start.image[0]);
    const dy = hundredths(press.image[1] - start.image[1]);
    if (this.#grip) {
      const { shape, handle } = this.#grip;
      const cap = movedHandle(shape.cap, handle, { dx, dy, from: start.image, pull: 0 });
      this.#desk.propose([withCap(shape, cap)]);
      return;
    }
    const [cx, cy] = start.image.map(hundredths);
    this.#circle = { kind: "circle", cx, cy, r: Math.max(SMALLEST_RADIUS, hundredths(Math.hypot(dx, dy))) };
    this.#desk.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    if (this.#grip) this.#desk.settle();
    else if (this.#circle) this.#place(this.#circle);
    else {
      const item = pick(this.#desk.pickable, press.image, 0);
      this.#desk.select(item ? [item.uid] : []);
    }
    this.#start = this.#circle = this.#grip = null;
  }

  /** @type {(circle: Circle) => void} */
  #place(circle) {
    const desk = this.#desk;
    const sole = desk.sole;
    if (sole && insideCap(sole.cap, circle.cx, circle.cy)) {
      desk.commit([changed(sole, withCap(sole, { ...sole.cap, mark: circle }))]);
      return;
    }
    const uid = newId();
    const blank = { uid, cap: newCap(), revision: 0, deleted: false, whole: null, centre: null, score: null };
    desk.commit([{ before: null, after: withCap(blank, newCap({ mark: circle })) }]);
    desk.select([uid]);
  }

  cancel() {
    const busy = this.#circle !== null || this.#grip !== null;
    this.#start = this.#circle = this.#grip = null;
    this.#desk.withdraw();
    this.#desk.signals.overlay.emit();
    return busy;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const circle = this.#circle;
    if (!circle) return false;
    context.beginPath();
    traceWhole(context, view, circle);
    context.fillStyle = FILLS.mark;
    context.fill();
    traceCross(context, ...toScreen(view, circle.cx, circle.cy), 6);
    strokeCased(context, { colour: COLOURS.mark, width: 2, casing: CASING });
    return true;
  };
}
