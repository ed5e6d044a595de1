/**
 * Selects caps and changes them by hand: drags vertices, centres and rims, puts vertices into edges,
 * moves whole caps.
 *
 * @module
 */

import { hundredths, insideCap } from "../../geometry/caps.js";
import { HANDLE_GAP_PX, handlesAreApart, movedHandle } from "../../geometry/handles.js";
import { same } from "../../geometry/same.js";
import { movedShape, withCap } from "../../geometry/shapes.js";
import { toImage } from "../../geometry/view.js";
import { drawBand, inBand } from "./band.js";
import { Clicks } from "./clicks.js";
import { drop, edgeAt, gripAt, handleAt, hasLost, pixels } from "./grip.js";
import { CLICK_PX, EDGE_PX, apart } from "./tool.js";
import { Removal } from "./removal.js";

/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./grip.js").Grip} Grip */
/** @typedef {import("./stroke.js").StrokeTool} StrokeTool */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** @implements {Tool} */
export class SelectTool {
  name = "select";
  cursor = "default";
  /** @type {Grip | null} */
  #grip = null;
  /** @type {Press | null} */
  #start = null;
  #moved = false;
  /** @type {Point} */
  #last = [0, 0];
  /** @type {Handle | null} */
  #under = null;
  /** @type {Point} */
  #at = [0, 0];
  /** A handle that was dragged stays active for the arrow keys until another is pointed at. */
  #keepsActive = false;
  #state;
  #rim;
  #removal;
  #clicks;

  /**
   * @param {EditorState} state
   * @param {Object} rest
   * @param {(text: string) => void} rest.say
   * @param {StrokeTool} rest.rim  what Ctrl and a drag do
   */
  constructor(state, { say, rim }) {
    this.#state = state;
    this.#rim = rim;
    this.#removal = new Removal(state, say);
    this.#clicks = new Clicks(state);
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const state = this.#state;
    this.#at = press.screen;
    this.#removal.moved(press.screen);
    if (press.ctrl) {
      this.cursor = this.#rim.cursor;
      return this.#rim.hover(press);
    }
    const { selection, sole } = state;
    const handle = sole && handleAt(state, sole, press.image);
    this.#under = handle;
    if (!same(handle, selection.handle) && (handle || !this.#keepsActive)) {
      selection.activate(handle);
      this.#keepsActive = false;
    }
    const item = handle ? null : state.at(press.image, pixels(state, EDGE_PX));
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
    this.cursor = this.#cursorFor(press, handle, item);
  }

  /** @type {(press: Press, handle: Handle | null, item: Shape | null) => string} */
  #cursorFor(press, handle, item) {
    if (handle) return handle.kind === "centre" ? "move" : "crosshair";
    const { selection, sole } = this.#state;
    if (sole && edgeAt(this.#state, sole, press.image)) return "copy";
    if (item && selection.has(item.uid)) return "move";
    return item ? "pointer" : "default";
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#state.commitDrafts();
    this.#at = press.screen;
    this.#start = press;
    this.#last = press.screen;
    this.#moved = false;
    this.#grip = gripAt(this.#state, press);
    if (this.#grip.kind === "rim") this.#rim.down(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    const start = this.#start;
    const grip = this.#grip;
    if (!start || !grip) return;
    this.#at = press.screen;
    if (grip.kind === "rim") return this.#rim.drag(press);
    if (this.#moved && hasLost(this.#state, grip)) {
      this.#grip = null;
      return;
    }
    if (!this.#moved && apart(press.screen, start.screen) < (grip.kind === "handle" ? 1 : CLICK_PX)) return;
    this.#moved = true;
    this.#state.selection.hover(null);
    const dx = hundredths(press.image[0] - start.image[0]);
    const dy = hundredths(press.image[1] - start.image[1]);
    if (grip.kind === "handle") this.#dragHandle(grip, dx, dy, press.alt);
    else if (grip.kind === "shape")
      this.#state.propose(grip.shapes.map((shape) => movedShape(shape, dx, dy)));
    else if (grip.kind === "band") this.#band(grip, press);
    else this.#state.viewport.panBy(press.screen[0] - this.#last[0], press.screen[1] - this.#last[1]);
    this.#last = press.screen;
  }

  /** @type {(grip: Grip & {kind: "handle"}, dx: number, dy: number, alone: boolean) => void} */
  #dragHandle({ shape, handle, pull }, dx, dy, alone) {
    const from = this.#start?.image ?? [0, 0];
    this.#state.selection.activate(handle);
    this.#keepsActive = true;
    const cap = movedHandle(shape.cap, handle, { dx, dy, from, pull: alone ? 0 : pull });
    this.#state.propose([withCap(shape, cap)]);
  }

  /** @type {(grip: Grip & {kind: "band"}, press: Press) => void} */
  #band(grip, press) {
    grip.band = { ...grip.band, to: press.image };
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    const grip = this.#grip;
    const state = this.#state;
    if (!grip) return;
    if (grip.kind === "rim") this.#rim.up(press);
    else if (this.#moved) {
      if (grip.kind === "band") state.select([...new Set([...state.selection.uids, ...inBand(state, grip.band)])]);
      else if (grip.kind === "handle") drop(state, grip.handle);
      else this.#state.commitDrafts();
    } else if (grip.kind === "handle" && press.alt) {
      this.#removeVertex(grip.handle);
    } else {
      this.#click(press);
    }
    this.#grip = null;
    this.hover(press);
  }

  /** @type {(press: Press) => void} */
  #click(press) {
    const state = this.#state;
    if (this.#grip?.kind === "handle" && !this.#meansAnother(this.#grip, press)) {
      this.#keepsActive = true;
      return;
    }
    const item = this.#clicks.meant(press);
    if (!press.shift) return state.select(item ? [item.uid] : []);
    if (!item) return;
    const others = [...state.selection.uids].filter((uid) => uid !== item.uid);
    state.select(state.selection.has(item.uid) ? others : [...others, item.uid]);
  }

  /** The ring of a mark runs over the caps beside it: a click there that moved nothing means the cap. @type {(grip: Grip & {kind: "handle"}, press: Press) => boolean} */
  #meansAnother({ shape, handle }, { image }) {
    return handle.kind === "rim" && !insideCap(shape.cap, ...image) && this.#state.at(image, 0) !== null;
  }

  /** Takes the vertex under the pointer out, where it can be told from its neighbours; else a lesser part there. */
  back() {
    const { sole } = this.#state;
    if (this.#grip) return true;
    if (!sole) return false;
    const apart = handlesAreApart(sole.cap, pixels(this.#state, HANDLE_GAP_PX));
    if ((apart && this.#removeVertex(this.#under)) || this.#removal.keepsCap()) return true;
    return this.#state.selection.hovered === null && this.#removal.removePart(this.#at);
  }

  /** @type {(handle: Handle | null) => boolean} */
  #removeVertex(handle) {
    if (!this.#removal.remove(handle, this.#at)) return false;
    const { sole, viewport } = this.#state;
    const here = toImage(viewport.view, ...this.#at);
    this.#under = sole && handleAt(this.#state, sole, here);
    return true;
  }

  /** @type {(press: Press) => void} */
  double(press) {
    if (this.#state.at(press.image, 0)) this.#state.reveal({ close: true });
  }

  /** Ends the drag as letting go would. */
  leave() {
    this.#grip = null;
    this.#removal.forget();
    this.#rim.leave();
    this.#state.commitDrafts();
  }

  cancel() {
    const busy = this.#rim.cancel() || (this.#grip !== null && this.#moved);
    this.#grip = null;
    this.#state.withdraw();
    this.#state.signals.overlay.emit();
    return busy;
  }

  /** While the pointer is pressed, what it drags is all that is taken back. */
  undo() {
    const pressed = this.#grip !== null;
    if (pressed) this.cancel();
    return pressed;
  }

  redo() {
    return this.#grip !== null;
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    if (this.#grip?.kind === "rim") return this.#rim.sketch(context, view);
    if (this.#grip?.kind !== "band" || !this.#moved) return false;
    drawBand(context, view, this.#grip.band);
    return true;
  };
}
