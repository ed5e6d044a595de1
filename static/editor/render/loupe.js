/**
 * A loupe beside the pointer: what lies under it, three times as large.
 *
 * @module
 */

import { visibleBounds } from "../geometry/view.js";
import { CASING } from "./palette.js";
import { traceCross, strokeCased } from "./paths.js";

/** @typedef {import("../geometry/bounds.js").Bounds} Bounds */
/** @typedef {import("../geometry/view.js").View} View */
/** @typedef {(context: CanvasRenderingContext2D, view: View, region: Bounds) => void} Paint */

const SIDE = 176;
const TIMES = 3;
/** From the pointer to the loupe's nearest corner. */
const AWAY = 26;

export class Loupe {
  #canvas = document.createElement("canvas");
  #context;
  #host;

  /** @param {HTMLElement} host */
  constructor(host) {
    this.#host = host;
    this.#canvas.className = "fairyring-loupe";
    this.#canvas.hidden = true;
    host.append(this.#canvas);
    const context = this.#canvas.getContext("2d");
    if (!context) throw new Error("This browser cannot draw on a canvas.");
    this.#context = context;
  }

  hide() {
    this.#canvas.hidden = true;
  }

  /**
   * @param {View} view
   * @param {import("../protocol.js").Point} at  the pointer, CSS pixels of the host
   * @param {{photo: Paint, caps: Paint, filter: string}} how
   */
  show(view, [x, y], { photo, caps, filter }) {
    const canvas = this.#canvas;
    const ratio = window.devicePixelRatio;
    const context = this.#context;
    canvas.hidden = false;
    canvas.width = canvas.height = Math.round(SIDE * ratio);
    canvas.style.left = `${x + AWAY + SIDE > this.#host.clientWidth ? x - AWAY - SIDE : x + AWAY}px`;
    canvas.style.top = `${y - AWAY - SIDE < 0 ? y + AWAY : y - AWAY - SIDE}px`;
    const half = SIDE / 2;
    const scale = view.scale * TIMES;
    const close = { scale, x: half + (view.x - x) * TIMES, y: half + (view.y - y) * TIMES };
    const region = visibleBounds(close, { width: SIDE, height: SIDE });
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.filter = filter || "none";
    photo(context, close, region);
    context.filter = "none";
    caps(context, close, region);
    context.beginPath();
    traceCross(context, half, half, 6);
    strokeCased(context, { colour: "#ffffff", width: 1, casing: CASING });
  }
}
