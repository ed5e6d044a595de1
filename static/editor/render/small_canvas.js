/**
 * A canvas over the picture, hardly larger than what is drawn on it: a browser without a GPU composes all of
 * a canvas anew whenever anything on it changes.
 *
 * @module
 */

/** @typedef {import("../geometry/view.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {{left: number, top: number, width: number, height: number, ratio: number}} Area  device pixels */

/** Its sides are multiples of this, CSS pixels, so that it rarely has to be cut anew. */
const PANE_PX = 128;

export class Glass {
  #canvas = document.createElement("canvas");
  #context;
  /** @type {Area} */
  #area = { left: 0, top: 0, width: 0, height: 0, ratio: 1 };
  #soiled = false;

  /** @param {HTMLElement} host */
  constructor(host) {
    const context = this.#canvas.getContext("2d");
    if (!context) throw new Error("This browser cannot draw on a canvas.");
    this.#context = context;
    host.append(this.#canvas);
  }

  /**
   * Wipes the glass and lays it over `bounds`, as far as they are in the viewport; `settle` ends the drawing.
   *
   * @param {Bounds | null} bounds  CSS pixels of the viewport; null takes the glass away
   * @param {Size} size  of the viewport
   * @param {number} ratio  device pixels per CSS pixel
   * @returns {CanvasRenderingContext2D | null}  to draw on in CSS pixels of the viewport; null: nothing is to be seen
   */
  lay(bounds, size, ratio) {
    const area = bounds && areaOf(bounds, size, ratio);
    if (!area || this.#fits(area)) this.#wipe();
    else this.#cut(area);
    return area && this.#context;
  }

  /** Something has been drawn on it. */
  soil() {
    this.#soiled = true;
  }

  /** Takes a glass that nothing has been drawn on away: a canvas in sight costs, drawn on or not. */
  settle() {
    this.#canvas.hidden = !this.#soiled;
  }

  /** @type {(area: Area) => boolean} */
  #fits(area) {
    const now = this.#area;
    const moved = area.left !== now.left || area.top !== now.top;
    return !moved && area.width === now.width && area.height === now.height && area.ratio === now.ratio;
  }

  #wipe() {
    if (!this.#soiled) return;
    this.#soiled = false;
    const context = this.#context;
    context.save();
    context.resetTransform();
    context.clearRect(0, 0, this.#area.width, this.#area.height);
    context.restore();
  }

  /** @type {(area: Area) => void} */
  #cut(area) {
    const { left, top, width, height, ratio } = area;
    const { style } = this.#canvas;
    this.#area = area;
    this.#soiled = false;
    this.#canvas.width = width;
    this.#canvas.height = height;
    style.width = `${width / ratio}px`;
    style.height = `${height / ratio}px`;
    style.transform = `translate(${left / ratio}px, ${top / ratio}px)`;
    const context = this.#context;
    context.setTransform(ratio, 0, 0, ratio, -left, -top);
    context.lineJoin = "round";
    context.lineCap = "round";
  }
}

/** Of the panes that the bounds touch. @type {(bounds: Bounds, size: Size, ratio: number) => Area | null} */
function areaOf({ x0, y0, x1, y1 }, { width, height }, ratio) {
  const [left, right] = panes(x0, x1, width, ratio);
  const [top, bottom] = panes(y0, y1, height, ratio);
  if (right <= left || bottom <= top) return null;
  return { left, top, width: right - left, height: bottom - top, ratio };
}

/** @type {(low: number, high: number, room: number, ratio: number) => [number, number]} */
function panes(low, high, room, ratio) {
  const start = Math.max(0, Math.floor(low / PANE_PX) * PANE_PX);
  const end = Math.min(room, Math.ceil(high / PANE_PX) * PANE_PX);
  return [Math.round(start * ratio), Math.round(end * ratio)];
}
