/**
 * Two fingers move and zoom the photo, whatever tool is in hand; one finger is the pointer.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/viewport.js").Viewport} Viewport */

export class Fingers {
  /** Where each finger is, CSS pixels of the host. @type {Map<number, Point>} */
  #at = new Map();
  #host;
  #viewport;
  #begun;

  /**
   * @param {HTMLElement} host
   * @param {Viewport} viewport
   * @param {() => void} begun  a second finger came down: what the first has begun is left
   */
  constructor(host, viewport, begun) {
    this.#host = host;
    this.#viewport = viewport;
    this.#begun = begun;
    const listen = (/** @type {string} */ type, /** @type {(event: PointerEvent) => boolean} */ hear) =>
      host.addEventListener(
        type,
        (event) => {
          if (!(event instanceof PointerEvent) || event.pointerType !== "touch") return;
          if (hear(event)) event.stopImmediatePropagation();
        },
        { capture: true },
      );
    listen("pointerdown", (event) => this.#down(event));
    listen("pointermove", (event) => this.#move(event));
    listen("pointerrawupdate", () => this.#at.size > 1);
    listen("pointerup", (event) => this.#up(event));
    listen("pointercancel", (event) => this.#up(event));
  }

  /** @type {(event: PointerEvent) => boolean} */
  #down(event) {
    this.#at.set(event.pointerId, this.#place(event));
    if (this.#at.size < 2) return false;
    if (this.#at.size === 2) this.#begun();
    this.#host.setPointerCapture(event.pointerId);
    event.preventDefault();
    return true;
  }

  /** @type {(event: PointerEvent) => boolean} */
  #move(event) {
    const before = this.#at.get(event.pointerId);
    if (!before) return false;
    const [other] = [...this.#at].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
    const now = this.#place(event);
    this.#at.set(event.pointerId, now);
    if (!other) return false;
    const middle = between(now, other);
    const [x, y] = between(before, other);
    this.#viewport.panBy(middle[0] - x, middle[1] - y);
    this.#viewport.zoomAt(...middle, apart(now, other) / Math.max(apart(before, other), 1));
    return true;
  }

  /** @type {(event: PointerEvent) => boolean} */
  #up(event) {
    const two = this.#at.size > 1;
    this.#at.delete(event.pointerId);
    return two;
  }

  /** @type {(event: PointerEvent) => Point} */
  #place(event) {
    const { left, top } = this.#host.getBoundingClientRect();
    return [event.clientX - left, event.clientY - top];
  }
}

/** @type {(a: Point, b: Point) => Point} */
function between([ax, ay], [bx, by]) {
  return [(ax + bx) / 2, (ay + by) / 2];
}

/** @type {(a: Point, b: Point) => number} */
function apart([ax, ay], [bx, by]) {
  return Math.hypot(ax - bx, ay - by);
}
