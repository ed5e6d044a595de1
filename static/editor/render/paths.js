/**
 * Puts geometry into canvas paths, in CSS pixels of a view, leaving out vertices too close to be told
 * apart at that scale.
 *
 * @module
 */

import { axesOf, placedWhole } from "../geometry/caps.js";
import { SHADE } from "./palette.js";

/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Whole} Whole */
/** @typedef {CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D} Context */

const CLOSEST = 1.25;

/** @type {(context: Context, view: View, ring: number[], close?: boolean) => void} */
export function traceRing(context, { scale, x, y }, ring, close = true) {
  let lastX = ring[0] * scale + x;
  let lastY = ring[1] * scale + y;
  context.moveTo(lastX, lastY);
  for (let i = 2; i < ring.length; i += 2) {
    const px = ring[i] * scale + x;
    const py = ring[i + 1] * scale + y;
    if (Math.abs(px - lastX) < CLOSEST && Math.abs(py - lastY) < CLOSEST && i < ring.length - 2) continue;
    context.lineTo(px, py);
    lastX = px;
    lastY = py;
  }
  if (close) context.closePath();
}

/** @type {(context: Context, view: View, whole: Whole) => void} */
export function traceWhole(context, view, whole) {
  const { a, b, angle } = axesOf(whole);
  const cx = whole.cx * view.scale + view.x;
  const cy = whole.cy * view.scale + view.y;
  context.moveTo(cx + a * view.scale * Math.cos(angle), cy + a * view.scale * Math.sin(angle));
  context.ellipse(cx, cy, a * view.scale, b * view.scale, angle, 0, 2 * Math.PI);
}

/** A cap's visible outline, and its mark where that is a circle or ellipse. @type {(context: Context, view: View, cap: Cap) => void} */
export function traceCap(context, view, cap) {
  for (const ring of cap.visible) traceRing(context, view, ring);
  const placed = placedWhole(cap);
  if (placed) traceWhole(context, view, placed);
}

/** A cross of `arm` CSS pixels. @type {(context: Context, x: number, y: number, arm: number) => void} */
export function traceCross(context, x, y, arm) {
  context.moveTo(x - arm, y);
  context.lineTo(x + arm, y);
  context.moveTo(x, y - arm);
  context.lineTo(x, y + arm);
}

/**
 * Strokes the current path: a dark casing under a bright line.
 *
 * @param {Context} context
 * @param {{colour: string, width: number, casing?: string | null}} how
 */
export function strokeCased(context, { colour, width, casing = null }) {
  if (casing) {
    context.strokeStyle = casing;
    context.lineWidth = width + 2;
    context.stroke();
  }
  context.strokeStyle = colour;
  context.lineWidth = width;
  context.stroke();
}

/**
 * Strokes the current path with lines of one pixel, the dark one shifted to the lower right: nearly as
 * legible as a casing, and several times quicker where thousands of shapes are drawn in software.
 *
 * @param {Context} context
 * @param {string} colour
 */
export function strokeShaded(context, colour) {
  context.lineWidth = 1;
  context.strokeStyle = SHADE;
  context.translate(1, 1);
  context.stroke();
  context.translate(-1, -1);
  context.strokeStyle = colour;
  context.stroke();
}

/**
 * A few words in the middle under a point of the screen, readable on any photo.
 *
 * @type {(context: Context, text: string, x: number, y: number) => void}
 */
export function writeCentred(context, text, x, y) {
  context.font = "600 12px system-ui, sans-serif";
  context.textAlign = "center";
  context.textBaseline = "top";
  context.lineWidth = 3;
  context.strokeStyle = "rgba(8, 12, 20, 0.9)";
  context.strokeText(text, x, y);
  context.fillStyle = "#ffffff";
  context.fillText(text, x, y);
}
