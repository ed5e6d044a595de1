/**
 * What every tool does with a pointer.
 *
 * @module
 */

/** @typedef {import("../../protocol.js").Point} Point */

/**
 * @typedef {Object} Press
 * @property {Point} screen CSS pixels from the top left of the canvas
 * @property {Point} image
 * @property {boolean} shift
 * @property {boolean} alt
 * @property {boolean} ctrl  Ctrl, or the Command key
 * @property {number} time  when the pointer was there, by the page's clock: the browser may tell a frame later
 */

/**
 * @typedef {Object} Tool
 * @property {string} name
 * @property {string} cursor
 * @property {() => void} [begin]  it is taken up
 * @property {(press: Press) => void} hover
 * @property {(press: Press) => void} down
 * @property {(press: Press) => void} drag
 * @property {(press: Press) => void} up
 * @property {(press: Press) => void} [double]
 * @property {() => boolean} cancel  drops what is half done; false when there was nothing
 * @property {() => void} leave  something else comes: what is half done is finished or kept, and never dropped
 * @property {() => boolean} [undo]  takes back the last step of what is half done; false where that is nothing
 * @property {() => boolean} [redo]  does it again; false where nothing is half done
 * @property {() => boolean} [finish]  Enter
 * @property {() => boolean} [back]  Backspace or Delete
 * @property {import("../../render/overlay.js").Sketch} [sketch]
 */

export const GRAB_PX = 9;
export const EDGE_PX = 6;
export const CLICK_PX = 4;
/** A line drawn by hand strays no farther than this from what was drawn: the eye sees no more. */
export const STRAYS_PX = 0.6;

/** @type {(a: Point, b: Point) => number} */
export function apart(a, b) {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}
