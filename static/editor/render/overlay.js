/**
 * What changes from frame to frame: the cap being edited with its handles, the one under the pointer, the
 * outline being drawn.
 *
 * @module
 */

import { joinedAll } from "../geometry/bounds.js";
import { boundsOfWhole, placedWhole, ringsOf } from "../geometry/caps.js";
import { HANDLE_GAP_PX, rimPoints } from "../geometry/handles.js";
import { isPrediction, reachOf } from "../geometry/shapes.js";
import { spacedVertices } from "../geometry/vertices.js";
import { toScreen } from "../geometry/view.js";
import { drawArcs, drawUncertainty, reachOfFit } from "./arcs.js";
import { hatch } from "./hatching.js";
import { CASING, COLOURS, FILLS } from "./palette.js";
import { strokeCased, traceCross, traceRing, traceWhole } from "./paths.js";
import { SmallCanvas } from "./small_canvas.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/handles.js").Handle} Handle */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {CanvasRenderingContext2D} Context */
/** @typedef {(context: Context, view: View) => boolean} Sketch  draws, and says whether there was anything to draw */

/** How far from an outline anything is drawn. */
const AROUND_PX = 28;

export class Overlay {
  #caps;
  #sketches;

  /** @param {HTMLElement} host */
  constructor(host) {
    this.#caps = new SmallCanvas(host);
    this.#sketches = new SmallCanvas(host);
  }

  /**
   * @param {EditorState} state
   * @param {number} ratio
   * @param {Sketch[]} sketches  of the tool in hand, of a conflict
   * @param {{still: boolean}} movement  of the photo: while it moves, nothing under the pointer is marked
   */
  draw(state, ratio, sketches, { still }) {
    const { view, size } = state.viewport;
    const hidden = state.layers.allHidden;
    const shapes = hidden ? [] : hoveredAndLifted(state, still);
    this.#caps.draw(onScreen(view, reachOfAll(shapes, state)), size, ratio, (context) => {
      drawShapes(context, shapes, state);
      return true;
    });
    const everywhere = { x0: 0, y0: 0, x1: size.width, y1: size.height };
    this.#sketches.draw(hidden ? null : everywhere, size, ratio, (context) =>
      sketches.map((sketch) => sketch(context, view)).includes(true),
    );
  }
}

/** What is to be drawn of them, image pixels. @type {(shapes: Shape[], state: EditorState) => Bounds | null} */
function reachOfAll(shapes, { explanation, layers }) {
  const all = shapes.flatMap((shape) => reachOf(shape) ?? []);
  const explained = shapes.length && explanation && layers.visible.whole ? reachOfFit(explanation) : null;
  return joinedAll(explained ? [...all, explained] : all);
}

/** @type {(state: EditorState, still: boolean) => Shape[]} */
function hoveredAndLifted(state, still) {
  const uids = state.lifted;
  if (still && state.selection.hovered) uids.add(state.selection.hovered);
  return [...uids].flatMap((uid) => state.shape(uid) ?? []);
}

/** @type {(view: View, bounds: Bounds | null) => Bounds | null} */
function onScreen(view, bounds) {
  if (!bounds) return null;
  const [x0, y0] = toScreen(view, bounds.x0, bounds.y0);
  const [x1, y1] = toScreen(view, bounds.x1, bounds.y1);
  return { x0: x0 - AROUND_PX, y0: y0 - AROUND_PX, x1: x1 + AROUND_PX, y1: y1 + AROUND_PX };
}

/** @type {(context: Context, shapes: Shape[], state: EditorState) => void} */
function drawShapes(context, shapes, state) {
  const { lifted } = state;
  for (const shape of shapes) {
    if (lifted.has(shape.uid)) drawLifted(context, shape, state);
    else drawHovered(context, state.viewport.view, shape);
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

/** @type {(context: Context, shape: Shape, state: EditorState) => void} */
function drawLifted(context, shape, { viewport, selection, drafts, layers, explanation }) {
  const { view } = viewport;
  const explained = selection.has(shape.uid) && layers.visible.whole ? explanation : null;
  if (shape.cap.ignored) hatch(context, view, [shape]);
  drawVisible(context, view, shape, { filled: layers.visible.fill, changed: drafts.has(shape.uid) });
  if (explained) drawArcs(context, view, explained);
  drawMark(context, view, shape);
  drawFit(context, view, shape);
  if (explained) drawUncertainty(context, view, explained);
  if (selection.soleUid === shape.uid) drawHandles(context, view, shape, selection.handle);
}

/** @type {(context: Context, view: View, shape: Shape, how: {filled: boolean, changed: boolean}) => void} */
function drawVisible(context, view, shape, { filled, changed }) {
  context.beginPath();
  for (const ring of shape.cap.visible) traceRing(context, view, ring);
  if (filled) {
    context.fillStyle = FILLS.selected;
    context.fill();
  }
  if (isPrediction(shape) && !changed) context.setLineDash([5, 4]);
  strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
  context.setLineDash([]);
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

/** @type {(context: Context, view: View, shape: Shape, active: Handle | null) => void} */
function drawHandles(context, view, { cap }, active) {
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
