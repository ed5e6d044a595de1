/**
 * The picture of all caps but those being edited. Painting is a generator: whoever runs it may pause
 * between handfuls of shapes, so that a bed of thousands never holds up the pointer.
 *
 * @module
 */

import { boundsOfWhole, measure } from "./caps.js";
import { CASING, COLOURS, FILLS } from "./palette.js";
import { strokeCased, traceCross, traceRing, traceWhole } from "./pen.js";
import { grown, joined, overlap, toScreen } from "./view.js";
import { isPrediction } from "./store.js";

/** @typedef {import("./palette.js").Style} Style */
/** @typedef {import("./store.js").Shape} Shape */
/** @typedef {import("./view.js").Bounds} Bounds */
/** @typedef {import("./view.js").View} View */
/** @typedef {CanvasRenderingContext2D} Context */
/** @typedef {Record<string, boolean>} Visible */

const HANDFUL = 24;
const SMALL_PX = 7;
const LABEL_PX = 30;

/**
 * @typedef {Object} Picture
 * @property {Shape[]} shapes
 * @property {Visible} visible  which layers
 * @property {Set<string>} selected
 */

/**
 * Paints the part of the picture inside `region` (image pixels).
 *
 * @param {Context} context
 * @param {View} view
 * @param {Bounds} region
 * @param {Picture} picture
 * @returns {Generator<void>}
 */
export function* paint(context, view, region, { shapes, visible, selected }) {
  context.lineJoin = "round";
  context.lineCap = "round";
  for (const [style, group] of groupsOf(shapes, view, region, selected, visible)) {
    for (let i = 0; i < group.length; i += HANDFUL) {
      paintHandful(context, view, group.slice(i, i + HANDFUL), style, visible);
      yield;
    }
  }
}

/** @type {(shapes: Shape[], view: View, region: Bounds, selected: Set<string>, visible: Visible) => Map<Style, Shape[]>} */
function groupsOf(shapes, view, region, selected, visible) {
  /** @type {Map<Style, Shape[]>} */
  const groups = new Map([["prediction", []], ["ignored", []], ["outline", []], ["selected", []]]);
  const near = grown(region, 24 / view.scale);
  for (const shape of shapes) {
    const bounds = reachOf(shape);
    if (!bounds || !overlap(bounds, near)) continue;
    const style = styleOf(shape, selected);
    if (style === "prediction" && !visible.prediction) continue;
    groups.get(style)?.push(shape);
  }
  return groups;
}

/** @type {(shape: Shape, selected: Set<string>) => Style} */
function styleOf(shape, selected) {
  if (selected.has(shape.uid)) return "selected";
  if (isPrediction(shape)) return "prediction";
  return shape.cap.ignored ? "ignored" : "outline";
}

/** Everything a shape may put on the canvas. @type {(shape: Shape) => Bounds | null} */
export function reachOf({ cap, whole }) {
  const { bounds } = measure(cap);
  if (!whole) return bounds;
  return bounds ? joined(bounds, boundsOfWhole(whole)) : boundsOfWhole(whole);
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style, visible: Visible) => void} */
function paintHandful(context, view, shapes, style, visible) {
  const large = shapes.filter((shape) => sizeOf(shape, view) >= SMALL_PX);
  if (visible.fill || style === "ignored") fillShapes(context, view, shapes, style);
  if (visible.outline || style === "prediction") strokeOutlines(context, view, shapes, style);
  if (visible.whole && style !== "ignored") strokeWholes(context, view, large);
  strokeMarks(context, view, large);
  if (visible.centre) strokeCentres(context, view, large, style);
  if (visible.label) for (const shape of large) writeLabel(context, view, shape);
  else for (const shape of large) if (shape.cap.doubtful) writeLabel(context, view, shape);
}

/** @type {(shape: Shape, view: View) => number} */
function sizeOf(shape, view) {
  const bounds = reachOf(shape);
  return bounds ? Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0) * view.scale : 0;
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style) => void} */
function fillShapes(context, view, shapes, style) {
  context.fillStyle = FILLS[style];
  for (const { cap } of shapes) {
    context.beginPath();
    for (const ring of cap.visible) traceRing(context, view, ring);
    context.fill();
  }
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style) => void} */
function strokeOutlines(context, view, shapes, style) {
  context.setLineDash(style === "prediction" ? [5, 4] : []);
  const line = { colour: style === "selected" ? COLOURS.selected : COLOURS[style === "mark" ? "outline" : style], width: 1.5 };
  for (const shape of shapes) {
    context.beginPath();
    for (const ring of shape.cap.visible) traceRing(context, view, ring);
    strokeCased(context, { ...line, casing: sizeOf(shape, view) >= SMALL_PX ? CASING : null });
  }
  context.setLineDash([]);
}

/** @type {(context: Context, view: View, shapes: Shape[]) => void} */
function strokeWholes(context, view, shapes) {
  context.beginPath();
  for (const { whole, cap } of shapes) {
    if (whole && whole !== cap.mark) traceWhole(context, view, whole);
  }
  strokeCased(context, { colour: COLOURS.whole, width: 1 });
}

/** @type {(context: Context, view: View, shapes: Shape[]) => void} */
function strokeMarks(context, view, shapes) {
  const marks = shapes.flatMap(({ cap }) => cap.mark ?? []);
  if (marks.length === 0) return;
  context.beginPath();
  for (const mark of marks) {
    if (mark.kind === "polygon") traceRing(context, view, mark.points);
    else traceWhole(context, view, mark);
  }
  strokeCased(context, { colour: COLOURS.mark, width: 1.5, casing: CASING });
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style) => void} */
function strokeCentres(context, view, shapes, style) {
  for (const marked of [false, true]) {
    context.beginPath();
    for (const { centre, cap } of shapes) {
      if (centre && (cap.mark !== null) === marked) traceCross(context, ...toScreen(view, ...centre), 4);
    }
    const colour = style === "prediction" ? COLOURS.prediction : marked ? COLOURS.mark : COLOURS.whole;
    strokeCased(context, { colour, width: 1.5, casing: CASING });
  }
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function writeLabel(context, view, shape) {
  const bounds = reachOf(shape);
  const text = labelOf(shape);
  if (!bounds || !text || (sizeOf(shape, view) < LABEL_PX && !shape.cap.doubtful)) return;
  const [x, y] = toScreen(view, (bounds.x0 + bounds.x1) / 2, bounds.y0);
  context.font = "600 11px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "top";
  context.lineWidth = 3;
  context.strokeStyle = "rgba(8, 12, 20, 0.8)";
  context.strokeText(text, x, y + 3);
  context.fillStyle = "#ffffff";
  context.fillText(text, x, y + 3);
}

/** @type {(shape: Shape) => string} */
export function labelOf({ cap, score, whole }) {
  const parts = [];
  if (cap.doubtful) parts.push("?");
  if (score !== null) parts.push(score.toFixed(2));
  else if (whole) parts.push(`⌀ ${Math.round(2 * Math.sqrt(whole.kind === "circle" ? whole.r ** 2 : whole.a * whole.b))}`);
  if (cap.order !== null && cap.order !== 0) parts.push(cap.order > 0 ? `▲${cap.order}` : `▼${-cap.order}`);
  if (cap.ignored) parts.push("ignored");
  return parts.join(" ");
}
