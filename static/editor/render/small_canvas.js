/**
 * A canvas over the picture, hardly larger than what is drawn on it: a browser without a GPU composes all of
 * a canvas anew whenever anything on it changes.
 *
 * @module
 */

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").Size} Size */
/** @typedef {{left: number, top: number, width: number, height: number, ratio: number}} Area  device pixels */

/** Its sides are multiples of this, CSS pixels, so that it rarely takes another size. */
const STEP_PX = 128;

export class SmallCanvas {
  #canvas = document.createElement("canvas");
  #context;
  /** @type {Area} */
  #area = { left: 0, top: 0, width: 0, height: 0, ratio: 1 };
  /** Something is drawn on it. */
  #drawn = false;

  /** @param {HTMLElement} host */
  constructor(host) {
    const context = this.#canvas.getContext("2d");
    if (!context) throw new Error("This browser cannot draw on a canvas.");
    this.#context = context;
    host.append(this.#canvas);
  }

  /**
   * Draws on an empty canvas over `bounds`, as far as they are in the viewport. Where nothing was drawn the
   * canvas is hidden: one in sight costs, drawn on or not.
   *
   * @param {Bounds | null} bounds  CSS pixels of the viewport; null for nothing
   * @param {Size} size  of the viewport
   * @param {number} ratio  device pixels per CSS pixel
   * @param {(context: CanvasRenderingContext2D) => boolean} paint  draws in CSS pixels of the viewport, and
   *   says whether there was anything to draw
   */
  draw(bounds, size, ratio, paint) {
    const area = bounds && areaOf(bounds, size, ratio);
    if (area && !this.#covers(area)) this.#move(area);
    else if (this.#drawn) this.#clear();
    this.#drawn = area !== null && paint(this.#context);
    this.#canvas.hidden = !this.#drawn;
  }

  /** @type {(area: Area) => boolean} */
  #covers(area) {
    const now = this.#area;
    const moved = area.left !== now.left || area.top !== now.top;
    return !moved && area.width === now.width && area.height === now.height && area.ratio === now.ratio;
  }

  #clear() {
    const context = this.#context;
    context.save();
    context.resetTransform();
    context.clearRect(0, 0, this.#area.width, this.#area.height);
    context.restore();
  }

  /** Setting the size of a canvas clears it. @type {(area: Area) => void} */
  #move(area) {
    const { left, top, width, height, ratio } = area;
    const { style } = this.#canvas;
    this.#area = area;
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

/** What of the viewport the bounds touch, in whole steps. @type {(bounds: Bounds, size: Size, ratio: number) => Area | null} */
function areaOf({ x0, y0, x1, y1 }, { width, height }, ratio) {
  const [left, right] = inSteps(x0, x1, width, ratio);
  const [top, bottom] = inSteps(y0, y1, height, ratio);
  if (right <= left || bottom <= top) return null;
  return { left, top, width: right - left, height: bottom - top, ratio };
}

/** @type {(low: number, high: number, room: number, ratio: number) => [number, number]} */
function inSteps(low, high, room, ratio) {
  const start = Math.max(0, Math.floor(low / STEP_PX) * STEP_PX);
  const end = Math.min(room, Math.ceil(high / STEP_PX) * STEP_PX);
  return [Math.round(start * ratio), Math.round(end * ratio)];
}
