/**
 * Selects caps and changes them by hand: drags vertices, centres and rims, puts vertices into edges,
 * moves whole caps.
 *
 * @module
 */

import { hundredths, insideCap } from "../../geometry/caps.js";
import { movedHandle, nearestHandle, sameHandle } from "../../geometry/handles.js";
import { pick, within } from "../../geometry/hit.js";
import { handlesAreApart } from "../../render/overlay.js";
import { changed, movedShape, withCap } from "../../geometry/shapes.js";
import { insertedVertices, nearestEdges, removedVertices } from "../../geometry/vertices.js";
import { CLICK_PX, EDGE_PX, GRAB_PX, apart } from "./tool.js";

/** @typedef {import("../../state/desk.js").Desk} Desk */
/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/store.js").Shape} Shape */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** How far along the outline, in CSS pixels, a dragged vertex pulls its neighbours. */
const PULL_PX = 16;

/**
 * What the press has taken hold of.
 *
 * @typedef {{kind: "handle", shape: Shape, handle: Handle, pull: number}
 *   | {kind: "shape", shapes: Shape[]}
 *   | {kind: "view"}
 *   | {kind: "band", to: Point}} Grip
 */

/** @implements {Tool} */
export class SelectTool {
  name = "select";
  cursor = "default";
  /** @type {Grip | null} */
  #grip = null;
  /** @type {Press | null} */
  #start = null;
  #moved = false;
  /** @type {Point} */
  #last = [0, 0];
  #desk;

  /** @param {Desk} desk */
  constructor(desk) {
    this.#desk = desk;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const desk = this.#desk;
    const sole = desk.sole;
    const handle = sole && this.#handleAt(sole, press);
    this.#under = handle;
    if (!sameHandle(handle, desk.active) && (handle || !this.#keepsActive)) {
      desk.active = handle;
      this.#keepsActive = false;
      desk.signals.overlay.emit();
    }
    const item = handle ? null : pick(desk.pickable, press.image, EDGE_PX / desk.lens.view.scale);
    desk.hover(item && !desk.selected.has(item.uid) ? item.uid : null);
    this.cursor = this.#cursorFor(press, handle, item);
  }

  /** @type {Handle | null} */
  #under = null;
  /** A handle that was dragged stays active for the arrow keys until another is pointed at. */
  #keepsActive = false;

  /** @type {(press: Press, handle: Handle | null, item: Shape | null) => string} */
  #cursorFor(press, handle, item) {
    if (handle) return handle.kind === "centre" ? "move" : "crosshair";
    const sole = this.#desk.sole;
    if (sole && this.#edgeAt(sole, press)) return "copy";
    if (item && this.#desk.selected.has(item.uid)) return "move";
    return item ? "pointer" : "default";
  }

  /** @type {(shape: Shape, press: Press) => Handle | null} */
  #handleAt(shape, press) {
    return nearestHandle(shape.cap, press.image, GRAB_PX / this.#desk.lens.view.scale);
  }

  /** @type {(shape: Shape, press: Press) => ReturnType<typeof nearestEdges>} */
  #edgeAt(shape, press) {
    return nearestEdges(shape.cap, press.image, EDGE_PX / this.#desk.lens.view.scale);
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#desk.settle();
    this.#start = press;
    this.#last = press.screen;
    this.#moved = false;
    this.#grip = this.#gripAt(press);
  }

  /** @type {(press: Press) => Grip} */
  #gripAt(press) {
    const desk = this.#desk;
    const sole = desk.sole;
    if (press.shift) return { kind: "band", to: press.image };
    if (sole) {
      const handle = this.#handleAt(sole, press);
      if (handle) return { kind: "handle", shape: sole, handle, pull: PULL_PX / desk.lens.view.scale };
      const edge = this.#edgeAt(sole, press);
      if (edge) {
        const { cap, vertices } = insertedVertices(sole.cap, edge.edges, edge.foot);
        return { kind: "handle", shape: { ...sole, cap }, handle: { kind: "vertex", vertices }, pull: 0 };
      }
    }
    const inside = desk.selection.some((shape) => insideCap(shape.cap, ...press.image));
    return inside ? { kind: "shape", shapes: desk.selection } : { kind: "view" };
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    const start = this.#start;
    const grip = this.#grip;
    if (!start || !grip) return;
    if (!this.#moved && apart(press.screen, start.screen) < (grip.kind === "handle" ? 1 : CLICK_PX)) return;
    this.#moved = true;
    this.#desk.hover(null);
    const dx = hundredths(press.image[0] - start.image[0]);
    const dy = hundredths(press.image[1] - start.image[1]);
    if (grip.kind === "handle") this.#dragHandle(grip, dx, dy, press.alt);
    else if (grip.kind === "shape") this.#desk.propose(grip.shapes.map((shape) => movedShape(shape, dx, dy)));
    else if (grip.kind === "band") this.#band(grip, press);
    else this.#desk.lens.panBy(press.screen[0] - this.#last[0], press.screen[1] - this.#last[1]);
    this.#last = press.screen;
  }

  /** @type {(grip: Grip & {kind: "handle"}, dx: number, dy: number, alone: boolean) => void} */
  #dragHandle({ shape, handle, pull }, dx, dy, alone) {
    const from = this.#start?.image ?? [0, 0];
    this.#desk.active = handle;
    this.#keepsActive = true;
    const cap = movedHandle(shape.cap, handle, { dx, dy, from, pull: alone ? 0 : pull });
    this.#desk.propose([withCap(shape, cap)]);
  }

  /** @type {(grip: Grip & {kind: "band"}, press: Press) => void} */
  #band(grip, press) {
    grip.to = press.image;
    this.#desk.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    const grip = this.#grip;
    if (!grip) return;
    if (this.#moved) {
      if (grip.kind === "band") this.#selectBand(grip);
      else this.#desk.settle();
    } else if (grip.kind === "handle" && press.alt) {
      this.#removeVertex(grip.handle);
    } else {
      this.#click(press);
    }
    this.#grip = null;
    this.hover(press);
  }

  /** @type {(press: Press) => void} */
  #click(press) {
    const desk = this.#desk;
    if (this.#grip?.kind === "handle") {
      this.#keepsActive = true;
      return;
    }
    const item = pick(desk.pickable, press.image, EDGE_PX / desk.lens.view.scale);
    if (!press.shift) return desk.select(item ? [item.uid] : []);
    if (!item) return;
    const others = [...desk.selected].filter((uid) => uid !== item.uid);
    desk.select(desk.selected.has(item.uid) ? others : [...others, item.uid]);
  }

  /** @type {(grip: Grip & {kind: "band"}) => void} */
  #selectBand(grip) {
    const desk = this.#desk;
    const found = within(desk.pickable, this.#bandBounds(grip));
    desk.select([...new Set([...desk.selected, ...found.map(({ uid }) => uid)])]);
  }

  /** @type {(grip: Grip & {kind: "band"}) => import("../../geometry/view.js").Bounds} */
  #bandBounds({ to }) {
    const [x, y] = this.#start?.image ?? to;
    return { x0: Math.min(x, to[0]), y0: Math.min(y, to[1]), x1: Math.max(x, to[0]), y1: Math.max(y, to[1]) };
  }

  /** Takes the vertex under the pointer out, where it can be told from its neighbours. */
  back() {
    const { sole, lens } = this.#desk;
    return sole !== null && handlesAreApart(sole, lens.view.scale) && this.#removeVertex(this.#under);
  }

  /** @type {(handle: Handle | null) => boolean} */
  #removeVertex(handle) {
    const desk = this.#desk;
    const sole = desk.sole;
    if (!sole || handle?.kind !== "vertex") return false;
    const cap = removedVertices(sole.cap, handle.vertices);
    desk.active = this.#under = null;
    if (cap) desk.commit([changed(sole, { ...sole, cap })]);
    return true;
  }

  /** @type {(press: Press) => void} */
  double(press) {
    if (pick(this.#desk.pickable, press.image, 0)) this.#desk.reveal({ close: true });
  }

  cancel() {
    const busy = this.#grip !== null && this.#moved;
    this.#grip = null;
    this.#desk.withdraw();
    return busy;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, { scale, x, y }) => {
    if (this.#grip?.kind !== "band" || !this.#moved) return false;
    const bounds = this.#bandBounds(this.#grip);
    const [left, top] = [bounds.x0 * scale + x, bounds.y0 * scale + y];
    const [right, bottom] = [bounds.x1 * scale + x, bounds.y1 * scale + y];
    context.setLineDash([4, 3]);
    context.strokeStyle = "#ffffff";
    context.lineWidth = 1;
    context.fillStyle = "rgba(255, 255, 255, 0.12)";
    context.fillRect(left, top, right - left, bottom - top);
    context.strokeRect(left, top, right - left, bottom - top);
    context.setLineDash([]);
    return true;
  };
}
