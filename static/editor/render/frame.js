/**
 * One drawing a frame, however many events came: the photo, the picture of the caps, the overlay. Notes
 * how long it took from the event's own time stamp to the end of the drawing.
 *
 * @module
 */

import { Overlay } from "./overlay.js";
import { paint, reachOf } from "./paint.js";
import { Studio } from "./paint_orders.js";
import { Surface } from "./surface.js";

/** @typedef {import("../state/desk.js").Desk} Desk */
/** @typedef {import("./overlay.js").Sketch} Sketch */
/** @typedef {import("./photos.js").Photos} Photos */
/** @typedef {import("../state/store.js").Shape} Shape */
/** @typedef {{event: number, drawn: number, draw_ms: number, kind: string}} Timing */

const TIMINGS_KEPT = 4096;
const MANY_RECTS = 60;

export class Frame {
  /** @type {Timing[]} */
  timings = [];
  /** @type {{event: number, kind: string} | null} */
  #cause = null;
  #asked = false;
  /** @type {(() => void)[]} */
  #whenComplete = [];
  #photo;
  #caps;
  #overlay;
  #desk;
  #sketches;

  /**
   * @param {HTMLElement} host
   * @param {Desk} desk
   * @param {Photos} photos
   * @param {() => Sketch[]} sketches
   */
  constructor(host, desk, photos, sketches) {
    this.#desk = desk;
    this.#sketches = sketches;
    const studio = new Studio();
    this.#photo = new Surface(host, {
      paint: (context, view, region) => photos.paint(context, view, region),
      ready: () => this.ask(),
    });
    this.#caps = new Surface(host, {
      paint: (context, view, region) => paint(context, view, region, this.#picture()),
      order: (frame) => studio.order(frame, { ...this.#picture(), shapes: desk.items, lifted: desk.lifted }),
      ready: () => this.ask(),
    });
    this.#overlay = new Overlay(host);
    desk.signals.overlay.listen(() => this.ask());
    desk.signals.picture.listen(() => this.redraw());
    desk.signals.shapes.listen((shapes) => this.#repair(shapes));
  }

  #picture() {
    const { items, lifted, layers, selected } = this.#desk;
    return { shapes: items.filter(({ uid }) => !lifted.has(uid)), visible: layers, selected };
  }

  /** @type {(event: number, kind: string) => void} */
  blame(event, kind) {
    this.#cause ??= { event, kind };
    this.ask();
  }

  ask() {
    if (this.#asked) return;
    this.#asked = true;
    requestAnimationFrame(() => this.#draw());
  }

  /** Draws the picture of the caps anew. */
  redraw() {
    this.#caps.discard();
    this.ask();
  }

  /** Draws the photo anew. */
  redrawPhoto() {
    this.#photo.discard();
    this.ask();
  }

  /** Another photo comes: the old one must not be seen under the new caps. */
  blank() {
    this.#photo.blank();
    this.#caps.blank();
  }

  /** @type {(filter: string) => void} */
  tint(filter) {
    this.#photo.tint(filter);
  }

  /** @type {(then: () => void) => void} */
  whenComplete(then) {
    this.#whenComplete.push(then);
    this.ask();
  }

  /** @type {(shapes: Shape[]) => void} */
  #repair(shapes) {
    if (shapes.length > MANY_RECTS) this.#caps.discard();
    else this.#caps.repair(shapes.flatMap((shape) => reachOf(shape) ?? []));
    this.ask();
  }

  #draw() {
    this.#asked = false;
    const started = performance.now();
    const { lens, layers, hidden } = this.#desk;
    const { view, size } = lens;
    if (size.width < 1 || size.height < 1) return;
    const ratio = window.devicePixelRatio;
    this.#photo.visible = layers.photo;
    this.#caps.visible = !hidden;
    this.#photo.show(view, size, ratio);
    const complete = this.#caps.show(view, size, ratio);
    this.#overlay.draw(this.#desk, ratio, this.#sketches());
    this.#note(started);
    if (complete) for (const then of this.#whenComplete.splice(0)) then();
  }

  /** @type {(started: number) => void} */
  #note(started) {
    if (!this.#cause) return;
    const drawn = performance.now();
    this.log({ ...this.#cause, drawn, draw_ms: drawn - started });
    this.#cause = null;
  }

  /** @type {(timing: Timing) => void} */
  log(timing) {
    this.timings.push(timing);
    if (this.timings.length > TIMINGS_KEPT) this.timings.splice(0, TIMINGS_KEPT / 4);
  }
}
