/**
 * Redraws a stretch of a cap's rim with one stroke, which begins and ends on it: along the rim it puts that
 * right, outside it adds to the cap, inside it cuts from it. The cap is the selected one, else the one whose
 * rim is nearest to where the stroke begins.
 *
 * @module
 */

import { hundredths } from "../../geometry/caps.js";
import { redrawnCap } from "../../geometry/rims.js";
import { withCap } from "../../geometry/shapes.js";
import { CASING, COLOURS } from "../../render/palette.js";
import { strokeCased, traceRing } from "../../render/paths.js";
import { changed } from "../../state/changes.js";
import { CLICK_PX, EDGE_PX, apart } from "./tool.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** Points of a stroke lie so far apart, CSS pixels. */
const STEP_PX = 2;
/** So near to the rim a stroke begins and ends, CSS pixels. */
const REACH_PX = 16;
/** The rim strays no farther than this from the stroke, CSS pixels: the eye sees no more. */
const STRAYS_PX = 0.6;

const ELSEWHERE = "A stroke begins and ends on the rim that it changes.";

/** @implements {Tool} */
export class RimTool {
  name = "rim";
  cursor = "crosshair";
  /** @type {Press | null} */
  #start = null;
  /** @type {Point[]} */
  #stroke = [];
  /** The stretch on the other side is meant. */
  #other = false;
  #state;
  #say;

  /**
   * @param {EditorState} state
   * @param {(text: string) => void} say
   */
  constructor(state, say) {
    this.#state = state;
    this.#say = say;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    const item = this.#state.at(press.image, this.#pixels(EDGE_PX));
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

  /** What the stroke makes of the cap whose rim it meets. @returns {{before: Shape, after: Shape} | null} */
  #redrawn() {
    if (this.#stroke.length < 3) return null;
    const how = {
      reach: this.#pixels(REACH_PX),
      tolerance: this.#pixels(STRAYS_PX),
      other: this.#other,
    };
    for (const before of this.#candidates(how.reach)) {
      const cap = redrawnCap(before.cap, this.#stroke, how);
      if (cap) return { before, after: withCap(before, cap) };
    }
    return null;
  }

  /** The caps that a stroke may mean: the selected one, those it begins at, those it runs through. @type {(reach: number) => Shape[]} */
  #candidates(reach) {
    const state = this.#state;
    const [first, middle] = [this.#stroke[0], this.#stroke[this.#stroke.length >> 1]];
    const all = [state.sole, ...state.rimsNear(first, reach), state.at(first, 0), state.at(middle, 0)];
    return all.filter((shape) => shape !== null);
  }

  /** Ends the stroke as letting go would. */
  leave() {
    const drawn = this.#stroke.length > 2;
    const redrawn = this.#redrawn();
    this.#forget();
    if (redrawn) {
      this.#state.select([redrawn.before.uid]);
      this.#state.commit([changed(redrawn.before, redrawn.after)]);
    } else if (drawn) this.#say(ELSEWHERE);
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

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    if (this.#stroke.length < 2) return false;
    const redrawn = this.#redrawn();
    context.beginPath();
    for (const ring of redrawn?.after.cap.visible ?? []) traceRing(context, view, ring);
    context.setLineDash([4, 4]);
    strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
    context.setLineDash([]);
    context.beginPath();
    traceRing(context, view, this.#stroke.flat(), false);
    strokeCased(context, {
      colour: redrawn ? COLOURS.draft : COLOURS.ignored,
      width: 2.5,
      casing: CASING,
    });
    return true;
  };
}
