/**
 * The pan and zoom transform: screen = image · scale + offset, screen in CSS pixels from the top left of
 * the canvas. Views are plain values; every function returns a new one.
 *
 * @module
 */

import { grown } from "./bounds.js";

/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("./bounds.js").Bounds} Bounds */
/** @typedef {{scale: number, x: number, y: number}} View */
/** @typedef {{width: number, height: number}} Size */

export const LARGEST_SCALE = 64;
/** One step towards a cap zooms in no further than this: the eye would lose where it is. */
const LARGEST_JUMP = 6;
/** What is smaller on screen, CSS pixels, is too small to work on. */
const WORKABLE_PX = 24;

/** @type {(view: View, x: number, y: number) => Point} */
export function toScreen(view, x, y) {
  return [x * view.scale + view.x, y * view.scale + view.y];
}

/** @type {(view: View, x: number, y: number) => Point} */
export function toImage(view, x, y) {
  return [(x - view.x) / view.scale, (y - view.y) / view.scale];
}

/** @type {(view: View, dx: number, dy: number) => View} */
export function panned(view, dx, dy) {
  return { ...view, x: view.x + dx, y: view.y + dy };
}

/**
 * Zooms by `factor`, keeping the image point under the screen point (x, y) where it is.
 *
 * @param {View} view
 * @param {{x: number, y: number, factor: number, smallest: number}} how
 * @returns {View}
 */
export function zoomed(view, { x, y, factor, smallest }) {
  const scale = Math.min(LARGEST_SCALE, Math.max(smallest, view.scale * factor));
  const ratio = scale / view.scale;
  return { scale, x: x - (x - view.x) * ratio, y: y - (y - view.y) * ratio };
}

/**
 * The view that shows all of `bounds` (image pixels), centred, `margin` CSS pixels from the edges.
 *
 * @param {Bounds} bounds
 * @param {Size} size
 * @param {number} margin
 * @returns {View}
 */
export function viewOf(bounds, size, margin) {
  const width = Math.max(bounds.x1 - bounds.x0, 1e-6);
  const height = Math.max(bounds.y1 - bounds.y0, 1e-6);
  const room = {
    width: Math.max(size.width - 2 * margin, 16),
    height: Math.max(size.height - 2 * margin, 16),
  };
  return centredOn(bounds, size, Math.min(room.width / width, room.height / height, LARGEST_SCALE));
}

/**
 * The view that shows `bounds` large, as far as one step may zoom in; the next step goes on.
 *
 * @param {View} view
 * @param {Bounds} bounds
 * @param {Size} size
 * @returns {View}
 */
export function closeUp(view, bounds, size) {
  const reach = Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0);
  const { scale } = viewOf(grown(bounds, reach / 2), size, 40);
  return centredOn(bounds, size, Math.min(scale, view.scale * LARGEST_JUMP));
}

/**
 * Moves as little as possible so that `bounds` is on screen; zooms only where it does not fit or would be
 * too small to work on, and then in no further than that takes.
 *
 * @param {View} view
 * @param {Bounds} bounds
 * @param {Size} size
 * @returns {View}
 */
export function revealing(view, bounds, size) {
  const margin = 40;
  const reach = Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0);
  const width = (bounds.x1 - bounds.x0) * view.scale;
  const height = (bounds.y1 - bounds.y0) * view.scale;
  const fits = width <= size.width - 2 * margin && height <= size.height - 2 * margin;
  if (!fits) return viewOf(grown(bounds, reach / 4), size, margin);
  if (reach * view.scale < WORKABLE_PX) {
    const scale = Math.min((2 * WORKABLE_PX) / Math.max(reach, 1e-6), view.scale * LARGEST_JUMP);
    return centredOn(bounds, size, Math.min(scale, LARGEST_SCALE));
  }
  const [left, top] = toScreen(view, bounds.x0, bounds.y0);
  return panned(view, shift(left, width, size.width, margin), shift(top, height, size.height, margin));
}

/** How near to the middle of the window something is that the eye need not look for, of its width and height. */
const MIDDLE = 0.3;

/** Brings the middle of `bounds` to that of the window, unless it is about there. @type {(view: View, bounds: Bounds, size: Size) => View} */
export function centred(view, bounds, size) {
  const [x, y] = toScreen(view, (bounds.x0 + bounds.x1) / 2, (bounds.y0 + bounds.y1) / 2);
  const [dx, dy] = [size.width / 2 - x, size.height / 2 - y];
  const near = Math.abs(dx) <= MIDDLE * size.width && Math.abs(dy) <= MIDDLE * size.height;
  return near ? view : panned(view, dx, dy);
}

/** @type {(bounds: Bounds, size: Size, scale: number) => View} */
function centredOn({ x0, y0, x1, y1 }, { width, height }, scale) {
  return { scale, x: (width - (x0 + x1) * scale) / 2, y: (height - (y0 + y1) * scale) / 2 };
}

/** @type {(start: number, length: number, room: number, margin: number) => number} */
function shift(start, length, room, margin) {
  if (start < margin) return margin - start;
  return Math.min(0, room - margin - (start + length));
}

/**
 * The part of the image on screen.
 *
 * @param {View} view
 * @param {Size} size
 * @returns {Bounds}
 */
export function visibleBounds(view, size) {
  const [x0, y0] = toImage(view, 0, 0);
  const [x1, y1] = toImage(view, size.width, size.height);
  return { x0, y0, x1, y1 };
}

/**
 * Offsets on whole device pixels, so that moving a drawn picture of the shapes stays sharp.
 *
 * @param {View} view
 * @param {number} ratio device pixels per CSS pixel
 * @returns {View}
 */
export function onDevicePixels(view, ratio) {
  return { ...view, x: Math.round(view.x * ratio) / ratio, y: Math.round(view.y * ratio) / ratio };
}
