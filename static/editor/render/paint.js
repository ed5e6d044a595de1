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
import { goodness, lineOf } from "./colouring.js";
import { CASING, COLOURS, FILLS, SHADE } from "./palette.js";
import { strokeCased, strokeShaded, traceCross, traceRing, traceWhole, writeCentred } from "./paths.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("./paths.js").Context} Context */
/** @typedef {Record<string, boolean>} Visible */
/** @typedef {"prediction" | "ignored" | "outline" | "checked" | "selected"} Style */

const SMALL_PX = 7;
/** Between these sizes on screen, pixels, what is drawn beside the outline of a cap comes into sight. */
const FADES = { whole: [26, 52], centre: [18, 36], label: [24, 40] };
/** From this crowd on, everything of it comes into sight later. */
const CROWD = 120;
const LATER = 1.4;
/** An uncertainty is drawn as twice its standard deviation, where that can be seen. */
const SPREADS = 2;
const LEAST_SPREAD_PX = 2;
/** How far from the outline anything of a shape may be drawn: lines, the cross, a label. */
const AROUND_PX = 24;
/** How much of the outlines of checked caps is seen where only open ones are to stand out. */
const FAINT = 0.35;
/** Lines of open caps then, CSS pixels. */
const OPEN_WIDTH = 2.5;
/** From this crowd on, lines are a device pixel wide: five times quicker to draw in software. */
const MANY = 400;

/**
 * @typedef {Object} Picture
 * @property {Shape[]} shapes  those farther away may be left out
 * @property {Visible} visible  which layers
 * @property {ReadonlySet<string>} selected
 * @property {import("./colouring.js").Colouring} [colouring]
 * @property {number} crowd  how many caps a window holds at this zoom, wherever it lies
 */

/**
 * How many of `count` caps a window holds, if they are spread over the whole photo. What is painted in part,
 * or while the photo is moved, is so painted alike.
 *
 * @type {(count: number, photo: Size, window: Size, scale: number) => number}
 */
export function crowdOf(count, photo, window, scale) {
  const across = Math.min(1, window.width / (photo.width * scale));
  const down = Math.min(1, window.height / (photo.height * scale));
  return count * across * down;
}

/**
 * Paints the part of the picture inside `region` (image pixels).
 *
 * @param {Context} context
 * @param {View} view
 * @param {Bounds} region
 * @param {Picture} picture
 */
export function paint(context, view, region, { shapes, visible, selected, colouring = "none", crowd }) {
  context.lineJoin = "round";
  context.lineCap = "round";
  const groups = groupsOf(shapes, view, region, selected, visible);
  const fine = crowd >= MANY;
  const later = crowd >= CROWD ? LATER : 1;
  for (const [style, group] of groups)
    paintGroup(context, view, group, { style, visible, fine, later, colouring });
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

/**
 * @typedef {Object} How
 * @property {Style} style
 * @property {Visible} visible
 * @property {boolean} fine  lines are a device pixel wide
 * @property {number} later  how much larger than usual caps are before more of them is drawn
 * @property {import("./colouring.js").Colouring} colouring
 */

/** @type {(context: Context, view: View, shapes: Shape[], how: How) => void} */
function paintGroup(context, view, shapes, how) {
  const { style, visible } = how;
  if (style === "checked" && !visible.checked) return paintFaintly(context, view, shapes, how);
  if (isOpen(how)) fillShapes(context, view, shapes, FILLS.open);
  const large = shapes.filter((shape) => sizeOf(shape, view) >= SMALL_PX);
  const ignored = shapes.filter(({ cap }) => cap.ignored);
  hatch(context, view, ignored);
  if (style === "selected" || (style !== "ignored" && visible.fill))
    fillShapes(context, view, shapes, FILLS[style]);
  /** @type {(part: keyof FADES, draw: (shape: Shape) => void) => void} */
  const faded = (part, draw) => {
    for (const shape of large) {
      const seen = style === "selected" ? 1 : seenAt(sizeOf(shape, view) / how.later, FADES[part]);
      if (seen === 0) continue;
      context.globalAlpha = seen;
      draw(shape);
    }
    context.globalAlpha = 1;
  };
  if (visible.whole && style !== "ignored") faded("whole", (shape) => strokeWhole(context, view, shape));
  if (visible.outline || style === "prediction" || style === "ignored")
    strokeOutlines(context, view, shapes, how);
  if (visible.whole && style !== "ignored") strokeMarks(context, view, large);
  if (visible.uncertainty && style !== "ignored") strokeUncertainties(context, view, large);
  if (visible.centre && style !== "ignored")
    faded("centre", (shape) => strokeCentre(context, view, shape, style));
  for (const shape of large) if (shape.cap.doubtful && !visible.label) writeLabel(context, view, shape, "?");
  if (visible.label) faded("label", (shape) => writeLabel(context, view, shape, labelOf(shape)));
}

/** Whether these are open caps that are to stand out. @type {(how: How) => boolean} */
function isOpen({ style, visible }) {
  return !visible.checked && (style === "prediction" || style === "outline");
}

/** Nothing but the outlines. @type {(context: Context, view: View, shapes: Shape[], how: How) => void} */
function paintFaintly(context, view, shapes, how) {
  context.globalAlpha = FAINT;
  strokeOutlines(context, view, shapes, { ...how, colouring: "none" });
  context.globalAlpha = 1;
}

/** From 0, not at all, to 1. @type {(size: number, between: number[]) => number} */
function seenAt(size, [from, to]) {
  return Math.min(Math.max((size - from) / (to - from), 0), 1);
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

/** @type {(context: Context, view: View, shapes: Shape[], how: How) => void} */
function strokeOutlines(context, view, shapes, how) {
  const { style, fine, colouring } = how;
  const usual = isOpen(how) ? OPEN_WIDTH : style === "ignored" ? 1 : 1.5;
  context.setLineDash(style === "prediction" ? [5, 4] : []);
  for (const shape of shapes) {
    const good = style === "ignored" || style === "selected" ? null : goodness(shape, colouring);
    const { colour, width } =
      good === null ? { colour: COLOURS[style], width: usual } : lineOf(good);
    if (style === "ignored") traceKnown(context, view, shape.cap);
    else traceVisible(context, view, shape);
    if (fine && good === null && usual < OPEN_WIDTH) strokeShaded(context, colour);
    else strokeCased(context, { colour, width, casing: CASING });
  }
  context.setLineDash([]);
}

/** @type {(context: Context, view: View, shape: Shape) => void} */
function strokeWhole(context, view, { whole, cap }) {
  if (!whole || cap.mark) return;
  context.beginPath();
  traceWhole(context, view, whole);
  strokeShaded(context, COLOURS.whole);
}

/** @type {(context: Context, view: View, shapes: Shape[]) => void} */
function strokeUncertainties(context, view, shapes) {
  context.fillStyle = FILLS.uncertainty;
  for (const { centre, sd } of shapes) {
    if (!centre || !sd) continue;
    const [rx, ry] = sd.map((one) => SPREADS * one * view.scale);
    if (Math.max(rx, ry) < LEAST_SPREAD_PX) continue;
    context.beginPath();
    context.ellipse(...toScreen(view, ...centre), rx, ry, 0, 0, 2 * Math.PI);
    context.fill();
    strokeShaded(context, COLOURS.uncertainty);
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

/** @type {(context: Context, view: View, shape: Shape, style: Style) => void} */
function strokeCentre(context, view, { centre, cap }, style) {
  if (!centre) return;
  context.beginPath();
  traceCross(context, ...toScreen(view, ...centre), 3.5);
  const colour = style === "prediction" ? COLOURS.prediction : cap.mark ? COLOURS.mark : COLOURS.whole;
  strokeCased(context, { colour, width: 1, casing: SHADE });
}

/** @type {(context: Context, view: View, shape: Shape, text: string) => void} */
function writeLabel(context, view, shape, text) {
  const bounds = reachOf(shape);
  if (!bounds || !text) return;
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
