/**
 * A tool that does something to caps with one stroke; a click selects.
 *
 * @module
 */

import { boundsOfPoints, contains, grown } from "../../geometry/bounds.js";
import { hundredths, measure } from "../../geometry/caps.js";
import { CASING, COLOURS, FADED, FILLS } from "../../render/palette.js";
import { strokeCased, traceRing, writeCentred } from "../../render/paths.js";
import { toScreen } from "../../geometry/view.js";
import { CLICK_PX, EDGE_PX, apart } from "./tool.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/changes.js").Change} Change */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** Points of a stroke lie so far apart, CSS pixels. */
const STEP_PX = 2;
/** So far beside a cap a stroke may run that is about it, as a share of its width. */
const BESIDE = 0.2;

/**
 * What a stroke does.
 *
 * @typedef {Object} Effect
 * @property {Change[]} changes  that of the cap which the stroke is about comes first
 * @property {Point[]} replaced  what of its rim gives way to the stroke
 * @property {string} note  in a few words, where they are needed; else ""
 */

/**
 * @typedef {Object} Meaning
 * @property {string} name  of the tool
 * @property {(stroke: Point[]) => string} without  what is said of a stroke that does nothing
 * @property {(stroke: Point[], other: boolean) => Effect | null} effect  `other`: Alt is held
 * @property {(point: Point) => Shape | null} meant  the cap that a stroke which begins there is for
 */

/** @implements {Tool} */
export class StrokeTool {
  cursor = "crosshair";
  /** @type {Press | null} */
  #start = null;
  /** @type {Point[]} */
  #stroke = [];
  /** A stroke that did nothing stays on screen until the next one, and is what undo takes back. @type {Point[]} */
  #refused = [];
  #other = false;
  #state;
  #say;
  #meaning;

  /**
   * @param {EditorState} state
   * @param {(text: string) => void} say
   * @param {Meaning} meaning
   */
  constructor(state, say, meaning) {
    this.name = meaning.name;
    this.#state = state;
    this.#say = say;
    this.#meaning = meaning;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    const item = this.#meaning.meant(press.image);
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
  }

  /** So many CSS pixels in pixels of the image. @type {(css: number) => number} */
  #pixels(css) {
    return css / this.#state.viewport.view.scale;
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#state.commitDrafts();
    this.#forget();
    this.#start = press;
    this.#stroke = [this.#inPhoto(press)];
  }

  /** @type {(press: Press) => Point} */
  #inPhoto({ image: [x, y] }) {
    const { width, height } = this.#state.image ?? { width: 0, height: 0 };
    return [hundredths(Math.min(width, Math.max(0, x))), hundredths(Math.min(height, Math.max(0, y)))];
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    const last = this.#stroke.at(-1);
    if (!last) return;
    const at = this.#inPhoto(press);
    this.#other = press.alt;
    if (apart(last, at) >= this.#pixels(STEP_PX)) this.#stroke.push(at);
    // From here on the stroke itself tells which cap it is about.
    if (this.#stroke.length > 2) this.#state.selection.hover(null);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    if (!this.#start) return;
    const clicked = apart(press.screen, this.#start.screen) < CLICK_PX && this.#stroke.length < 3;
    this.#other = press.alt;
    if (!clicked) return this.leave();
    this.#forget();
    const item = this.#state.at(press.image, this.#pixels(EDGE_PX));
    this.#state.select(item ? [item.uid] : []);
  }

  #effect() {
    return this.#stroke.length < 3 ? null : this.#meaning.effect(this.#stroke, this.#other);
  }

  /** Ends the stroke as letting go would. */
  leave() {
    const stroke = this.#stroke;
    const effect = this.#effect();
    this.#forget();
    if (effect) {
      const [{ after }] = effect.changes;
      this.#state.commit(effect.changes);
      this.#state.select([after.uid]);
    } else if (stroke.length > 2) {
      this.#refused = stroke;
      this.#say(this.#meaning.without(stroke));
    }
  }

  #forget() {
    this.#start = null;
    this.#stroke = [];
    this.#refused = [];
    this.#other = false;
    this.#state.signals.overlay.emit();
  }

  cancel() {
    const busy = this.#start !== null || this.#refused.length > 0;
    this.#forget();
    return busy;
  }

  /** The stroke that is drawn, or did nothing, is all that is taken back. */
  undo() {
    return this.cancel();
  }

  redo() {
    return this.#start !== null;
  }

  /** The cap that the stroke is about, what would become of the caps, dashed, and the stroke upon it. @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const stroke = this.#refused.length ? this.#refused : this.#stroke;
    if (stroke.length < 2) return false;
    const effect = this.#effect();
    if (effect) drawGivingWay(context, view, effect);
    context.beginPath();
    for (const { after } of effect?.changes ?? [])
      for (const ring of after.cap.visible) traceRing(context, view, ring);
    context.setLineDash([4, 4]);
    strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
    context.setLineDash([]);
    context.beginPath();
    traceRing(context, view, stroke.flat(), false);
    strokeCased(context, {
      colour: effect ? COLOURS.draft : COLOURS.ignored,
      width: 2.5,
      casing: CASING,
    });
    const [x, y] = toScreen(view, ...stroke[stroke.length - 1]);
    if (effect?.note) writeCentred(context, effect.note, x, y + 14);
    return true;
  };
}

/** Fills the cap that a stroke is about, and has the piece of its rim that is to go fade. @type {(context: CanvasRenderingContext2D, view: import("../../geometry/view.js").View, effect: Effect) => void} */
function drawGivingWay(context, view, { changes: [{ before }], replaced }) {
  context.beginPath();
  for (const ring of before?.cap.visible ?? []) traceRing(context, view, ring);
  context.fillStyle = FILLS.selected;
  context.fill();
  context.beginPath();
  traceRing(context, view, replaced.flat(), false);
  context.lineWidth = 2.5;
  context.strokeStyle = FADED;
  context.stroke();
}

/**
 * The visible caps that a stroke may be about, those whose rim is nearest to its beginning first: both of its ends lie
 * on or near them, or its middle.
 *
 * @type {(state: EditorState, stroke: Point[], reach: number) => Shape[]}
 */
export function aroundStroke(state, stroke, reach) {
  const bounds = boundsOfPoints(stroke.flat());
  const all = [...state.rimsNear(stroke[0], reach), ...state.near(grown(bounds, reach + longerSide(bounds) / 2))];
  const [first, middle, last] = [stroke[0], stroke[stroke.length >> 1], stroke[stroke.length - 1]];
  const meant = all.filter(({ cap }) => {
    const own = measure(cap).bounds;
    if (!own) return false;
    const around = grown(own, Math.max(reach, BESIDE * longerSide(own)));
    const holds = (/** @type {Point} */ [x, y]) => contains(around, { x0: x, y0: y, x1: x, y1: y });
    return holds(middle) || (holds(first) && holds(last));
  });
  return [...new Map(meant.map((shape) => [shape.uid, shape])).values()];
}

/** @type {(bounds: import("../../geometry/bounds.js").Bounds) => number} */
function longerSide({ x0, y0, x1, y1 }) {
  return Math.max(x1 - x0, y1 - y0);
}
