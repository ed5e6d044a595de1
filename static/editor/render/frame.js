/**
 * One drawing a frame, however many events came: the photo, the picture of the caps, the overlay. Notes
 * how long it took from the event's own time stamp to the end of the drawing.
 *
 * @module
 */

import { joined } from "../geometry/bounds.js";
import { reachOf } from "../geometry/shapes.js";
import { CachedPicture } from "./cached_picture.js";
import { Loupe } from "./loupe.js";
import { Overlay } from "./overlay.js";
import { Movement } from "./movement.js";
import { crowdOf, nearTo, paint } from "./paint.js";
import { PaintOrders } from "./paint_orders.js";
import { photoFilter } from "./photo_filter.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./overlay.js").Sketch} Sketch */
/** @typedef {import("./photos.js").Photos} Photos */
/** @typedef {{event: number, drawn: number, draw_ms: number, kind: string}} Timing */

const TIMINGS_KEPT = 4096;
/** From so many shapes on, a new picture is sooner there than so many repairs. */
const MANY = 60;

/** How far from the caps anything of them may be drawn: lines, words. */
const BEYOND_PX = 64;

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
  #state;
  #sketches;
  #photos;
  #filter = "";
  #movement = new Movement(() => this.ask());
  #loupe;
  /** Where the pointer is, CSS pixels of the host; null where it is elsewhere. @type {import("../protocol.js").Point | null} */
  #pointer = null;

  /**
   * @param {HTMLElement} host
   * @param {EditorState} state
   * @param {Photos} photos
   * @param {() => Sketch[]} sketches
   */
  constructor(host, state, photos, sketches) {
    this.#state = state;
    this.#sketches = sketches;
    this.#photos = photos;
    const filter = photoFilter(host);
    const ready = () => this.ask();
    this.#photo = new CachedPicture(host, {
      paint: (context, view, region) => photos.paint(context, view, region),
      ready,
    });
    this.#caps = this.#capsIn(host, ready);
    this.#overlay = new Overlay(host);
    this.#loupe = new Loupe(host);
    this.#followPointer(host);
    state.look.changed.listen((before, now) => {
      this.#filter = filter(now);
      this.#photo.tint(this.#filter);
      if (before.local !== now.local) void photos.useLocal(now.local);
      if (before.colouring !== now.colouring) this.redraw();
      this.ask();
    });
    state.signals.overlay.listen(() => this.ask());
    state.signals.picture.listen(() => this.redraw());
    state.signals.shapes.listen((shapes) => this.#repair(shapes));
  }

  /** The picture of all caps but those that the overlay shows. @type {(host: HTMLElement, ready: () => void) => CachedPicture} */
  #capsIn(host, ready) {
    const { items, layers, look, selection } = this.#state;
    const orders = new PaintOrders();
    return new CachedPicture(host, {
      paint: (context, view, region) => this.#paintCaps(context, view, region),
      order: (extent) => {
        return orders.order(extent, {
          shapes: items.all,
          visible: layers.visible,
          selected: selection.uids,
          lifted: this.#state.lifted,
          colouring: look.now.colouring,
          crowd: this.#crowdAt(extent.view),
        });
      },
      ready,
    });
  }

  /** All caps but those that the overlay shows. @type {(context: import("./paths.js").Context, view: import("../geometry/view.js").View, region: import("../geometry/bounds.js").Bounds) => void} */
  #paintCaps = (context, view, region) => {
    const { lifted, items, layers, look, selection } = this.#state;
    const shapes = items.near(nearTo(region, view)).filter(({ uid }) => !lifted.has(uid));
    paint(context, view, region, {
      shapes,
      visible: layers.visible,
      selected: selection.uids,
      colouring: look.now.colouring,
      crowd: this.#crowdAt(view),
    });
  };

  /** @type {(view: import("../geometry/view.js").View) => number} */
  #crowdAt({ scale }) {
    const { image, items, layers, viewport } = this.#state;
    const count = items.all.filter((shape) => layers.show(shape)).length;
    return crowdOf(count, image ?? viewport.size, viewport.size, scale);
  }

  /** An event came that changes what is seen; the timing of the next frame is counted from it. @type {(event: number, kind: string) => void} */
  causedBy(event, kind) {
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

  /** @type {(host: HTMLElement) => void} */
  #followPointer(host) {
    host.addEventListener("pointermove", (event) => {
      const box = host.getBoundingClientRect();
      this.#pointer = [event.clientX - box.left, event.clientY - box.top];
      if (this.#state.look.now.loupe) this.ask();
    });
    host.addEventListener("pointerleave", () => {
      this.#pointer = null;
      this.ask();
    });
  }

  #drawLoupe() {
    const { look, viewport } = this.#state;
    if (!look.now.loupe || !this.#pointer) return this.#loupe.hide();
    this.#loupe.show(viewport.view, this.#pointer, {
      photo: (context, view, region) => this.#photos.paint(context, view, region),
      caps: this.#paintCaps,
      filter: this.#filter,
    });
  }

  /** @type {(then: () => void) => void} */
  whenComplete(then) {
    this.#whenComplete.push(then);
    this.ask();
  }

  /** @type {(shapes: Shape[]) => void} */
  #repair(shapes) {
    if (shapes.length > MANY) this.#caps.discard();
    else this.#caps.repair(shapes.flatMap((shape) => reachOf(shape) ?? []));
    this.ask();
  }

  #draw() {
    this.#asked = false;
    const started = performance.now();
    const { viewport, layers, items } = this.#state;
    const { view, size } = viewport;
    if (size.width < 1 || size.height < 1) return;
    const ratio = window.devicePixelRatio;
    const photo = photoBounds(this.#state.image);
    this.#photo.visible = layers.visible.photo;
    this.#caps.visible = !layers.allHidden;
    const movement = this.#movement.follow(view);
    const photoShown = this.#photo.show({ view, size, ratio, content: photo, beyond: 0 }, movement);
    const content = joined(photo, items.bounds ?? photo);
    const capsShown = this.#caps.show({ view, size, ratio, content, beyond: BEYOND_PX }, movement);
    this.#overlay.draw(this.#state, ratio, this.#sketches(), movement);
    this.#drawLoupe();
    this.#note(started);
    if (photoShown && capsShown) for (const then of this.#whenComplete.splice(0)) then();
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

/** @type {(image: import("../protocol.js").Image | null) => import("../geometry/bounds.js").Bounds} */
function photoBounds(image) {
  return { x0: 0, y0: 0, x1: image?.width ?? 1, y1: image?.height ?? 1 };
}
