/**
 * Which piece of the image a cached picture shows, how finely, and for which views it will do.
 *
 * @module
 */

import { contains, grown } from "../geometry/bounds.js";
import { toScreen } from "../geometry/view.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {{view: View, width: number, height: number, ratio: number}} Extent  of a picture, whose top left corner is the origin of `view`; CSS pixels, and device pixels in one of them */
/**
 * What is to be seen: `content` is all that there is to draw, image pixels; lines and words of it reach
 * `beyond` its edges, CSS pixels.
 *
 * @typedef {{view: View, size: Size, ratio: number, content: Bounds, beyond: number}} Wanted
 */

/**
 * What a picture is made for: to be looked at and moved, or to be stretched while the photo is enlarged or
 * shrunk by and by.
 *
 * @typedef {"moving" | "enlarging" | "shrinking"} Use
 */

/** How far a picture reaches beyond the window that may be moved, CSS pixels. */
const MARGIN = 192;
/** How far beyond it, of the window's width and height, one that is made while zooming out. */
const WIDE = 0.5;
/** How much coarser those are that are made while zooming: they are soon made, and soon on screen. */
const COARSER = 2;
/** A picture stretched or shrunk further shows lines too thick or too thin. */
const MOST_STRETCH = 2;
/** So many steps of a movement are looked ahead. */
const AHEAD = 2;

/**
 * The extent of a picture that shows what is wanted, and what lies around it as far as there is anything.
 *
 * @type {(wanted: Wanted, use: Use) => Extent}
 */
export function extentOf({ view, size, ratio, content, beyond }, use) {
  const fine = use === "moving" ? ratio : ratio / COARSER;
  const around = marginOf(size, use);
  const there = grown(onScreen(content, view), beyond);
  /** @type {(value: number) => number} */
  const down = (value) => Math.floor(value * fine) / fine;
  const [left, top] = [down(Math.max(-around.x, there.x0)), down(Math.max(-around.y, there.y0))];
  const right = Math.min(size.width + around.x, there.x1);
  const bottom = Math.min(size.height + around.y, there.y1);
  return {
    view: { ...view, x: view.x - left, y: view.y - top },
    width: Math.max(1, Math.ceil((right - left) * fine)) / fine,
    height: Math.max(1, Math.ceil((bottom - top) * fine)) / fine,
    ratio: fine,
  };
}

/** @type {(size: Size, use: Use) => {x: number, y: number}} */
function marginOf({ width, height }, use) {
  if (use === "moving") return { x: MARGIN, y: MARGIN };
  return use === "shrinking" ? { x: WIDE * width, y: WIDE * height } : { x: 0, y: 0 };
}

/** Where a picture lies on screen. @type {(extent: Extent, view: View) => {x: number, y: number, stretch: number}} */
export function placeOf(extent, view) {
  const stretch = view.scale / extent.view.scale;
  return { x: view.x - extent.view.x * stretch, y: view.y - extent.view.y * stretch, stretch };
}

/** Whether a picture shows what is wanted, as sharply as the screen can. @type {(extent: Extent, wanted: Wanted) => boolean} */
export function isSharp(extent, { view, ratio }) {
  return extent.view.scale === view.scale && extent.ratio === ratio;
}

/** Whether a picture, moved and stretched, leaves nothing of the window bare. @type {(extent: Extent, wanted: Wanted) => boolean} */
export function covers(extent, { view, size, content }) {
  const { x, y, stretch } = placeOf(extent, view);
  const there = onScreen(content, view);
  const needed = {
    x0: Math.max(0, there.x0),
    y0: Math.max(0, there.y0),
    x1: Math.min(size.width, there.x1),
    y1: Math.min(size.height, there.y1),
  };
  if (needed.x1 <= needed.x0 || needed.y1 <= needed.y0) return true;
  const shown = { x0: x, y0: y, x1: x + extent.width * stretch, y1: y + extent.height * stretch };
  // Half a pixel is what rounding comes to.
  return contains(grown(shown, 0.5), needed);
}

/** Whether a picture is stretched so much that another would be better soon. @type {(extent: Extent, view: View) => boolean} */
export function isOverstretched(extent, view) {
  const { stretch } = placeOf(extent, view);
  return stretch > MOST_STRETCH || stretch < 1 / MOST_STRETCH;
}

/** Where a movement leads that goes on as it did from one view to the next. @type {(before: View, now: View) => View} */
export function goneOn(before, now) {
  const factor = now.scale / before.scale;
  let [last, next] = [before, now];
  for (let step = 0; step < AHEAD; step++) {
    const further = {
      scale: next.scale * factor,
      x: next.x + factor * (next.x - last.x),
      y: next.y + factor * (next.y - last.y),
    };
    [last, next] = [next, further];
  }
  return next;
}

/** @type {(bounds: Bounds, view: View) => Bounds} */
function onScreen(bounds, view) {
  const [x0, y0] = toScreen(view, bounds.x0, bounds.y0);
  const [x1, y1] = toScreen(view, bounds.x1, bounds.y1);
  return { x0, y0, x1, y1 };
}
