/**
 * A tool that does something to caps with one stroke; a click selects.
 *
 * @module
 */

import { hundredths } from "../../geometry/caps.js";
import { CASING, COLOURS } from "../../render/palette.js";
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

/**
 * What a stroke does.
 *
 * @typedef {Object} Effect
 * @property {Change[]} changes
 * @property {string} note  in a few words, where they are needed; else ""
 */

/**
 * @typedef {Object} Meaning
 * @property {string} name  of the tool
 * @property {string} elsewhere  said of a stroke that does nothing
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
    const drawn = this.#stroke.length > 2;
    const effect = this.#effect();
    this.#forget();
    if (effect) {
      const [{ after }] = effect.changes;
      this.#state.commit(effect.changes);
      this.#state.select([after.uid]);
    } else if (drawn) this.#say(this.#meaning.elsewhere);
  }

  #forget() {
    this.#start = null;
    this.#stroke = [];
    this.#other = false;
    this.#state.signals.overlay.emit();
  }

  cancel() {
    const busy = this.#start !== null;
    this.#forget();
    return busy;
  }

  /** While the pointer is pressed, the stroke is all that is taken back. */
  undo() {
    return this.cancel();
  }

  redo() {
    return this.#start !== null;
  }

  /** What would become of the caps, dashed, under the stroke. @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    if (this.#stroke.length < 2) return false;
    const effect = this.#effect();
    context.beginPath();
    for (const { after } of effect?.changes ?? [])
      for (const ring of after.cap.visible) traceRing(context, view, ring);
    context.setLineDash([4, 4]);
    strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
    context.setLineDash([]);
    context.beginPath();
    traceRing(context, view, this.#stroke.flat(), false);
    strokeCased(context, {
      colour: effect ? COLOURS.draft : COLOURS.ignored,
      width: 2.5,
      casing: CASING,
    });
    const [x, y] = toScreen(view, ...this.#stroke[this.#stroke.length - 1]);
    if (effect?.note) writeCentred(context, effect.note, x, y + 14);
    return true;
  };
}

/**
 * The caps that a stroke may mean: the selected one, those it begins at, those it runs through.
 *
 * @type {(state: EditorState, stroke: Point[], reach: number) => Shape[]}
 */
export function meantBy(state, stroke, reach) {
  const [first, middle] = [stroke[0], stroke[stroke.length >> 1]];
  const all = [state.sole, ...state.rimsNear(first, reach), state.at(first, 0), state.at(middle, 0)];
  return all.filter((shape) => shape !== null);
}
