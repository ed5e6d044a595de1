/**
 * Pointer and wheel: panning and zooming are the same with every tool, the rest is handed to the tool in
 * hand.
 *
 * @module
 */

import { toImage } from "../geometry/view.js";

/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Press} Press */
/** @typedef {import("./tools/tool.js").Tool} Tool */

const WHEEL_SPEED = 0.0016;
const LINE_PX = 16;
/** Some mice tell where they are a thousand times a second. */
const RAW_MS = 4;

export class Pointer {
  /** @type {Point} */
  at = [0, 0];
  #panKey = false;
  /** The view has been moved since the key was pressed that pans while it is held. */
  panned = false;
  #panning = false;
  #pressed = false;
  /** The tools that were in hand at the last presses; a double click is one tool's. @type {Tool[]} */
  #pressedWith = [];
  #rawAt = 0;
  #host;
  #state;
  #tool;
  #caused;

  /**
   * @param {HTMLElement} host
   * @param {EditorState} state
   * @param {Object} rest
   * @param {() => Tool} rest.tool  the one in hand
   * @param {(event: number, kind: string) => void} rest.caused  when an event came that changes what is seen
   */
  constructor(host, state, { tool, caused }) {
    this.#host = host;
    this.#state = state;
    this.#tool = tool;
    this.#caused = caused;
    host.addEventListener("pointerdown", (event) => this.#down(event));
    host.addEventListener("pointermove", (event) => this.#move(event));
    host.addEventListener("pointerrawupdate", (event) => this.#raw(/** @type {PointerEvent} */ (event)));
    host.addEventListener("pointerup", (event) => this.#up(event));
    host.addEventListener("pointercancel", () => this.#cancel());
    host.addEventListener("pointerleave", () => state.selection.hover(null));
    host.addEventListener("dblclick", (event) => this.#double(event));
    host.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    host.addEventListener("contextmenu", (event) => event.preventDefault());
    for (const kind of /** @type {const} */ (["keydown", "keyup"]))
      window.addEventListener(kind, (event) => this.#modified(event));
  }

  /** A key is held by which the primary button pans. */
  get panKey() {
    return this.#panKey;
  }

  set panKey(held) {
    if (held && !this.#panKey) this.panned = false;
    this.#panKey = held;
  }

  /** Whether a tool is at work. */
  get pressed() {
    return this.#pressed;
  }

  /** @type {(event: MouseEvent) => Press} */
  #press(event) {
    const box = this.#host.getBoundingClientRect();
    this.at = [event.clientX - box.left, event.clientY - box.top];
    const { shiftKey: shift, altKey: alt } = event;
    const image = toImage(this.#state.viewport.view, ...this.at);
    const ctrl = event.ctrlKey || event.metaKey;
    return { screen: this.at, image, shift, alt, ctrl, time: event.timeStamp };
  }

  /** @type {(event: PointerEvent) => void} */
  #down(event) {
    if (isChrome(event)) return;
    this.#host.focus({ preventScroll: true });
    this.#host.setPointerCapture(event.pointerId);
    const press = this.#press(event);
    if (event.button !== 0 || this.panKey) this.#panning = this.panned = true;
    else {
      this.#pressed = true;
      this.#state.beginGesture();
      this.#pressedWith = [...this.#pressedWith.slice(-1), this.#tool()];
      this.#tool().down(press);
    }
    event.preventDefault();
    this.cursor();
  }

  /**
   * A move before the browser holds it back until the next frame: so what is asked of the server is asked
   * half a frame sooner. Not every browser tells.
   *
   * @type {(event: PointerEvent) => void}
   */
  #raw(event) {
    if (!this.#pressed || this.#panning || event.timeStamp - this.#rawAt < RAW_MS) return;
    this.#rawAt = event.timeStamp;
    this.#drag(event);
  }

  /** Ctrl changes what a press would do, also while the pointer rests. @type {(event: KeyboardEvent) => void} */
  #modified({ key, shiftKey: shift, altKey: alt, ctrlKey, metaKey, timeStamp: time }) {
    if (key !== "Control" && key !== "Meta") return;
    if (this.#pressed || this.#panning || !this.#host.matches(":hover")) return;
    const image = toImage(this.#state.viewport.view, ...this.at);
    this.#tool().hover({ screen: this.at, image, shift, alt, ctrl: ctrlKey || metaKey, time });
    this.cursor();
  }

  /** @type {(event: PointerEvent) => void} */
  #drag(event) {
    const [x, y] = this.at;
    const press = this.#press(event);
    if (press.screen[0] === x && press.screen[1] === y) return;
    this.#tool().drag(press);
    this.#caused(event.timeStamp, "drag");
  }

  /**
   * The first click of two may have ended the work of one tool and the second have begun another's.
   *
   * @type {(event: MouseEvent) => void}
   */
  #double(event) {
    if (isChrome(event)) return;
    const tool = this.#tool();
    if (this.#pressedWith.every((other) => other === tool)) tool.double?.(this.#press(event));
  }

  /** @type {(event: PointerEvent) => void} */
  #move(event) {
    // The release was not heard, as the pointer was outside the window.
    if (this.#pressed && event.buttons === 0) {
      this.#drag(event);
      this.#up(event);
    } else if (this.#pressed && !this.#panning) this.#drag(event);
    else this.#wander(event);
    this.cursor();
  }

  /** @type {(event: PointerEvent) => void} */
  #wander(event) {
    const [x, y] = this.at;
    const press = this.#press(event);
    if (this.#panning) {
      this.#state.viewport.panBy(this.at[0] - x, this.at[1] - y);
      this.#caused(event.timeStamp, "pan");
    } else {
      this.#tool().hover(press);
      this.#caused(event.timeStamp, "hover");
    }
  }

  /** @type {(event: PointerEvent) => void} */
  #up(event) {
    const press = this.#press(event);
    if (this.#pressed && event.button <= 0) {
      this.#pressed = false;
      this.#tool().up(press);
      this.#state.endGesture();
      this.#caused(event.timeStamp, "release");
    }
    if (event.buttons === 0) this.#panning = false;
    this.cursor();
  }

  #cancel() {
    if (this.#pressed) this.#tool().leave();
    this.letGo();
  }

  /** Another tool or image has come: what is pressed drags nothing of it. */
  letGo() {
    this.#state.endGesture();
    this.#pressed = this.#panning = false;
  }

  /** @type {(event: WheelEvent) => void} */
  #wheel(event) {
    if (isChrome(event)) return;
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === WheelEvent.DOM_DELTA_LINE ? LINE_PX : 1);
    const speed = event.ctrlKey ? 6 * WHEEL_SPEED : WHEEL_SPEED;
    this.#state.viewport.zoomAt(...this.at, Math.exp(-pixels * speed));
    this.#caused(event.timeStamp, "zoom");
  }

  /** Shows what a press would do. */
  cursor() {
    const cursor = this.#panning ? "grabbing" : this.panKey ? "grab" : this.#tool().cursor;
    if (this.#host.style.cursor !== cursor) this.#host.style.cursor = cursor;
  }
}

/** Whether an event belongs to what lies over the photo. @type {(event: Event) => boolean} */
function isChrome({ target }) {
  return target instanceof Element && target.closest("[data-fairyring-chrome]") !== null;
}
