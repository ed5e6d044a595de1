/**
 * What changes from frame to frame: the cap being edited with its handles, the one under the pointer, the
 * outline being drawn.
 *
 * @module
 */

import { drawArcs, drawUncertainty, reachOfFit } from "./arcs.js";
import { boundsOfWhole, measure, placedWhole, ringsOf } from "../geometry/caps.js";
import { Glass } from "./small_canvas.js";
import { rimPoints } from "../geometry/handles.js";
import { CASING, COLOURS, FILLS } from "./palette.js";
import { reachOf } from "./paint.js";
import { strokeCased, traceCross, traceRing, traceWhole } from "./paths.js";
import { isPrediction } from "../state/store.js";
import { spacedVertices } from "../geometry/vertices.js";
import { joined, toScreen } from "../geometry/view.js";

/** @typedef {import("../state/desk.js").Desk} Desk */
/** @typedef {import("../geometry/handles.js").Handle} Handle */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/store.js").Shape} Shape */
/** @typedef {import("../geometry/view.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {CanvasRenderingContext2D} Context */
/** @typedef {(context: Context, view: View) => boolean} Sketch  draws, and says whether there was anything to draw */

/** Handles no closer than this, or they would hide the rim they are on. */
const HANDLE_GAP_PX = 13;
const REACH_PX = 28;

export class Overlay {
  #caps;
  #sketches;

  /** @param {HTMLElement} host */
  constructor(host) {
    this.#caps = new Glass(host);
    this.#sketches = new Glass(host);
  }

  /**
   * @param {Desk} desk
   * @param {number} ratio
   * @param {Sketch[]} sketches  of the tool in hand, of a conflict
   */
  draw(desk, ratio, sketches) {
    this.#drawCaps(desk, ratio);
    this.#drawSketches(desk, ratio, sketches);
  }

  /** @type {(desk: Desk, ratio: number) => void} */
  #drawCaps(desk, ratio) {
    const shapes = desk.hidden ? [] : hoveredAndLifted(desk);
    const context = this.#caps.lay(onScreen(desk.lens.view, reachOfAll(shapes, desk)), desk.lens.size, ratio);
    if (context) {
      this.#caps.soil();
      drawShapes(context, shapes, desk);
    }
    this.#caps.settle();
  }

  /** @type {(desk: Desk, ratio: number, sketches: Sketch[]) => void} */
  #drawSketches({ hidden, lens }, ratio, sketches) {
    const { size, view } = lens;
    const context = this.#sketches.lay({ x0: 0, y0: 0, x1: size.width, y1: size.height }, size, ratio);
    if (context && !hidden) for (const sketch of sketches) if (sketch(context, view)) this.#sketches.soil();
    this.#sketches.settle();
  }
}

/** What is to be drawn of them, image pixels. @type {(shapes: Shape[], desk: Desk) => Bounds | null} */
function reachOfAll(shapes, { explanation, layers }) {
  const all = shapes.flatMap((shape) => reachOf(shape) ?? []);
  const explained = shapes.length && explanation && layers.whole ? reachOfFit(explanation) : null;
  if (explained) all.push(explained);
  return all.length ? all.reduce(joined) : null;
}

/** @type {(desk: Desk) => Shape[]} */
function hoveredAndLifted(desk) {
  const uids = desk.lifted;
  if (desk.hovered) uids.add(desk.hovered);
  return [...uids].flatMap((uid) => desk.drafts.get(uid) ?? desk.item(uid) ?? []);
}

/** @type {(view: View, bounds: Bounds | null) => Bounds | null} */
function onScreen(view, bounds) {
  if (!bounds) return null;
  const [x0, y0] = toScreen(view, bounds.x0, bounds.y0);
  const [x1, y1] = toScreen(view, bounds.x1, bounds.y1);
  return { x0: x0 - REACH_PX, y0: y0 - REACH_PX, x1: x1 + REACH_PX, y1: y1 + REACH_PX };
}

/** @type {(context: Context, shapes: Shape[], desk: Desk) => void} */
function drawShapes(context, shapes, desk) {
  for (const shape of shapes) {
    const only = shape.uid === desk.hovered && !desk.lifted.has(shape.uid);
    if (only) drawHovered(context, desk.lens.view, shape);
    else drawLifted(context, desk.lens.view, shape, desk);
  }
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function drawHovered(context, view, shape) {
  context.beginPath();
  for (const ring of shape.cap.visible) traceRing(context, view, ring);
  const placed = shape.cap.visible.length ? null : placedWhole(shape.cap);
  if (placed) traceWhole(context, view, placed);
  context.fillStyle = isPrediction(shape) ? FILLS.prediction : FILLS.selected;
  context.fill();
  strokeCased(context, { colour: COLOURS.selected, width: 1.5, casing: CASING });
}

/** @type {(context: Context, view: View, shape: Shape, desk: Desk) => void} */
function drawLifted(context, view, shape, desk) {
  const { cap } = shape;
  const selected = desk.selected.has(shape.uid);
  context.beginPath();
  for (const ring of cap.visible) traceRing(context, view, ring);
  if (desk.layers.fill) {
    context.fillStyle = FILLS.selected;
    context.fill();
  }
  if (isPrediction(shape) && !desk.drafts.has(shape.uid)) context.setLineDash([5, 4]);
  strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
  context.setLineDash([]);
  const explanation = selected && desk.layers.whole ? desk.explanation : null;
  if (explanation) drawArcs(context, view, explanation);
  drawMark(context, view, shape);
  drawFit(context, view, shape);
  if (explanation) drawUncertainty(context, view, explanation);
  if (selected && desk.selected.size === 1) drawHandles(context, view, shape, desk);
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function drawMark(context, view, { cap }) {
  if (!cap.mark) return;
  context.beginPath();
  if (cap.mark.kind === "polygon") traceRing(context, view, cap.mark.points);
  else traceWhole(context, view, cap.mark);
  strokeCased(context, { colour: COLOURS.mark, width: 1.5, casing: CASING });
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function drawFit(context, view, { cap, whole, centre }) {
  if (whole && !placedWhole(cap)) {
    context.beginPath();
    traceWhole(context, view, whole);
    context.setLineDash([7, 4]);
    strokeCased(context, { colour: COLOURS.whole, width: 1.5, casing: CASING });
    context.setLineDash([]);
  }
  if (!centre) return;
  context.beginPath();
  traceCross(context, ...toScreen(view, ...centre), 7);
  strokeCased(context, { colour: cap.mark ? COLOURS.mark : COLOURS.whole, width: 1.5, casing: CASING });
}

/** @type {(context: Context, view: View, shape: Shape, desk: Desk) => void} */
function drawHandles(context, view, { cap }, desk) {
  const active = desk.active;
  const gap = HANDLE_GAP_PX / view.scale;
  context.beginPath();
  for (const ring of ringsOf(cap)) {
    for (const index of spacedVertices(ring, gap)) {
      squareAt(context, toScreen(view, ring[2 * index], ring[2 * index + 1]), 2);
    }
  }
  const placed = placedWhole(cap);
  if (placed?.kind === "circle")
    for (const point of rimPoints(placed)) squareAt(context, toScreen(view, ...point), 3);
  paintHandles(context, "#ffffff");
  if (active) drawActive(context, view, cap, active);
}

/**
 * The handle under the pointer, or last dragged: arrow keys move it.
 *
 * @type {(context: Context, view: View, cap: Cap, active: Handle) => void}
 */
function drawActive(context, view, cap, active) {
  const placed = placedWhole(cap);
  context.beginPath();
  if (active.kind === "vertex") {
    const { ring, index } = active.vertices[0];
    const points = ringsOf(cap)[ring];
    if (points && 2 * index < points.length) {
      squareAt(context, toScreen(view, points[2 * index], points[2 * index + 1]), 4);
    }
  } else if (placed && active.kind === "rim") {
    squareAt(context, toScreen(view, boundsOfWhole(placed).x1, placed.cy), 4);
  } else if (placed) {
    const [x, y] = toScreen(view, placed.cx, placed.cy);
    context.arc(x, y, 9, 0, 2 * Math.PI);
    strokeCased(context, { colour: COLOURS.mark, width: 1.5, casing: CASING });
    return;
  }
  paintHandles(context, COLOURS.mark);
}

/** @type {(context: Context, at: Point, half: number) => void} */
function squareAt(context, [x, y], half) {
  context.rect(x - half, y - half, 2 * half, 2 * half);
}

/** @type {(context: Context, colour: string) => void} */
function paintHandles(context, colour) {
  context.fillStyle = colour;
  context.fill();
  context.strokeStyle = "#0b1220";
  context.lineWidth = 1;
  context.stroke();
}

/**
 * Whether a vertex of the cap has room for a handle of its own at this scale.
 *
 * @type {(shape: Shape, scale: number) => boolean}
 */
export function handlesAreApart({ cap }, scale) {
  const { bounds } = measure(cap);
  if (!bounds) return false;
  const count = ringsOf(cap).reduce((sum, ring) => sum + ring.length / 2, 0);
  const around = 3 * Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0) * scale;
  return around / Math.max(count, 1) >= HANDLE_GAP_PX;
}
