/**
 * The picture of all caps but those being edited. It is painted in a worker (`paint_worker.js`), and in
 * part on the main thread where one cap has changed.
 *
 * @module
 */

import { grown, overlap } from "../geometry/bounds.js";
import { isPrediction, reachOf } from "../geometry/shapes.js";
import { toScreen } from "../geometry/view.js";
import { hatch, traceKnown } from "./hatching.js";
import { CASING, COLOURS, FILLS, SHADE } from "./palette.js";
import { strokeCased, strokeShaded, traceCross, traceRing, traceWhole, writeCentred } from "./paths.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("./paths.js").Context} Context */
/** @typedef {Record<string, boolean>} Visible */
/** @typedef {"prediction" | "ignored" | "outline" | "checked" | "selected"} Style */

const SMALL_PX = 7;
const LABEL_PX = 30;
/** How far from the outline anything of a shape may be drawn: lines, the cross, a label. */
const AROUND_PX = 24;
/** From this many shapes on, lines are a device pixel wide: five times quicker to draw in software. */
const MANY = 400;

/**
 * @typedef {Object} Picture
 * @property {Shape[]} shapes  those farther away may be left out
 * @property {Visible} visible  which layers
 * @property {ReadonlySet<string>} selected
 */

/**
 * Paints the part of the picture inside `region` (image pixels).
 *
 * @param {Context} context
 * @param {View} view
 * @param {Bounds} region
 * @param {Picture} picture
 */
export function paint(context, view, region, { shapes, visible, selected }) {
  context.lineJoin = "round";
  context.lineCap = "round";
  const groups = groupsOf(shapes, view, region, selected, visible);
  const count = [...groups.values()].reduce((sum, group) => sum + group.length, 0);
  const fine = count >= MANY;
  for (const [style, group] of groups) paintGroup(context, view, group, { style, visible, fine });
}

/** The rectangle whose shapes may show in `region`, image pixels. @type {(region: Bounds, view: View) => Bounds} */
export function nearTo(region, { scale }) {
  return grown(region, AROUND_PX / scale);
}

/** @type {(shapes: Shape[], view: View, region: Bounds, selected: ReadonlySet<string>, visible: Visible) => Map<Style, Shape[]>} */
function groupsOf(shapes, view, region, selected, visible) {
  /** @type {Map<Style, Shape[]>} */
  const groups = new Map([
    ["prediction", []],
    ["ignored", []],
    ["checked", []],
    ["outline", []],
    ["selected", []],
  ]);
  const near = nearTo(region, view);
  for (const shape of shapes) {
    const bounds = reachOf(shape);
    if (!bounds || !overlap(bounds, near)) continue;
    const style = styleOf(shape, selected);
    if (style === "prediction" && !visible.prediction) continue;
    groups.get(style)?.push(shape);
  }
  return groups;
}

/** @type {(shape: Shape, selected: ReadonlySet<string>) => Style} */
function styleOf(shape, selected) {
  if (selected.has(shape.uid)) return "selected";
  if (isPrediction(shape)) return "prediction";
  if (shape.cap.ignored) return "ignored";
  return shape.checked ? "checked" : "outline";
}

/** @type {(context: Context, view: View, shapes: Shape[], how: {style: Style, visible: Visible, fine: boolean}) => void} */
function paintGroup(context, view, shapes, { style, visible, fine }) {
  const large = shapes.filter((shape) => sizeOf(shape, view) >= SMALL_PX);
  const ignored = shapes.filter(({ cap }) => cap.ignored);
  hatch(context, view, ignored);
  if (style === "selected" || (style !== "ignored" && visible.fill))
    fillShapes(context, view, shapes, FILLS[style]);
  if (visible.whole && style !== "ignored") strokeWholes(context, view, large);
  if (visible.outline || style === "prediction" || style === "ignored")
    strokeOutlines(context, view, shapes, style, fine);
  if (visible.whole && style !== "ignored") strokeMarks(context, view, large);
  if (visible.centre && style !== "ignored") strokeCentres(context, view, large, style);
  for (const shape of large) {
    const text = visible.label ? labelOf(shape) : shape.cap.doubtful ? "?" : "";
    if (text) writeLabel(context, view, shape, text);
  }
}

/** @type {(shape: Shape, view: View) => number} */
function sizeOf(shape, view) {
  const bounds = reachOf(shape);
  return bounds ? Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0) * view.scale : 0;
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function traceVisible(context, view, { cap }) {
  context.beginPath();
  for (const ring of cap.visible) traceRing(context, view, ring);
}

/** @type {(context: Context, view: View, shapes: Shape[], fill: string | CanvasPattern) => void} */
function fillShapes(context, view, shapes, fill) {
  context.fillStyle = fill;
  for (const shape of shapes) {
    traceVisible(context, view, shape);
    context.fill();
  }
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style, fine: boolean) => void} */
function strokeOutlines(context, view, shapes, style, fine) {
  context.setLineDash(style === "prediction" ? [5, 4] : []);
  const colour = COLOURS[style];
  for (const shape of shapes) {
    if (style === "ignored") traceKnown(context, view, shape.cap);
    else traceVisible(context, view, shape);
    if (fine) strokeShaded(context, colour);
    else
      strokeCased(context, {
        colour,
        width: style === "ignored" ? 1 : 1.5,
        casing: CASING,
      });
  }
  context.setLineDash([]);
}

/** @type {(context: Context, view: View, shapes: Shape[]) => void} */
function strokeWholes(context, view, shapes) {
  for (const { whole, cap } of shapes) {
    if (!whole || cap.mark) continue;
    context.beginPath();
    traceWhole(context, view, whole);
    strokeShaded(context, COLOURS.whole);
  }
}

/** @type {(context: Context, view: View, shapes: Shape[]) => void} */
function strokeMarks(context, view, shapes) {
  for (const { cap } of shapes) {
    if (!cap.mark) continue;
    context.beginPath();
    if (cap.mark.kind === "polygon") traceRing(context, view, cap.mark.points);
    else traceWhole(context, view, cap.mark);
    strokeShaded(context, COLOURS.mark);
  }
}

/** @type {(context: Context, view: View, shapes: Shape[], style: Style) => void} */
function strokeCentres(context, view, shapes, style) {
  for (const { centre, cap } of shapes) {
    if (!centre) continue;
    context.beginPath();
    traceCross(context, ...toScreen(view, ...centre), 3.5);
    const colour = style === "prediction" ? COLOURS.prediction : cap.mark ? COLOURS.mark : COLOURS.whole;
    strokeCased(context, { colour, width: 1, casing: SHADE });
  }
}

/** @type {(context: Context, view: View, shape: Shape, text: string) => void} */
function writeLabel(context, view, shape, text) {
  const bounds = reachOf(shape);
  if (!bounds || (sizeOf(shape, view) < LABEL_PX && !shape.cap.doubtful)) return;
  const [x, y] = toScreen(view, (bounds.x0 + bounds.x1) / 2, bounds.y0);
  writeCentred(context, text, x, y + 3);
}

/** @type {(shape: Shape) => string} */
function labelOf({ cap, score, whole }) {
  const parts = [];
  if (cap.doubtful) parts.push("?");
  if (score !== null) parts.push(score.toFixed(2));
  else if (whole)
    parts.push(`⌀ ${Math.round(2 * Math.sqrt(whole.kind === "circle" ? whole.r ** 2 : whole.a * whole.b))}`);
  if (cap.order !== null && cap.order !== 0) parts.push(cap.order > 0 ? `▲${cap.order}` : `▼${-cap.order}`);
  if (cap.ignored) parts.push("ignored");
  return parts.join(" ");
}
