/**
 * Says what pieces of the selected cap's outline are, where the fit has taken one for something else: a click
 * gives the piece that is meant the next kind, a drag along the outline the stretch that it runs along. The fit
 * follows.
 *
 * @module
 */

import { hundredths } from "../../geometry/caps.js";
import { withCap } from "../../geometry/shapes.js";
import { called, middleOf, nearestArc, nextKind, uncalled } from "../../geometry/told_arcs.js";
import { nearestEdges } from "../../geometry/vertices.js";
import { toScreen } from "../../geometry/view.js";
import { ARCS, CASING, COLOURS } from "../../render/palette.js";
import { strokeCased, traceRing, writeCentred } from "../../render/paths.js";
import { changed } from "../../state/changes.js";
import { CLICK_PX, EDGE_PX, GRAB_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").Arc} Arc */
/** @typedef {import("../../protocol.js").Cap} Cap */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** Points of a drag along the outline lie so far apart, and so far from the outline at most, CSS pixels. */
const STEP_PX = 4;
const ALONG_PX = 24;

const MARKED = "The whole outline of this cap is its mark: what is said of its rim changes nothing.";

/** @implements {Tool} */
export class ArcsTool {
  name = "arcs";
  cursor = "default";
  /** @type {Press | null} */
  #start = null;
  /** The arc that the press began on. @type {Arc | null} */
  #taken = null;
  /** Where the drag ran along the outline. @type {Point[]} */
  #along = [];
  /** @type {Point | null} */
  #at = null;
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

  /** So many CSS pixels in pixels of the image. @type {(css: number) => number} */
  #pixels(css) {
    return css / this.#state.viewport.view.scale;
  }

  /** @type {(at: Point) => Arc | null} */
  #arcAt(at) {
    return nearestArc(this.#state.explanation?.arcs ?? [], at, this.#pixels(GRAB_PX));
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection, signals } = this.#state;
    this.#at = press.image;
    const arc = this.#arcAt(press.image);
    this.cursor = arc ? "pointer" : "default";
    const item = arc ? null : this.#state.at(press.image, this.#pixels(EDGE_PX));
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
    signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#state.commitDrafts();
    this.#start = press;
    this.#taken = this.#arcAt(press.image);
    this.#along = [];
    if (this.#taken) this.#follow(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    if (!this.#taken) return;
    this.#follow(press);
    this.#state.signals.overlay.emit();
  }

  /** Adds the place on the outline beside the pointer. @type {(press: Press) => void} */
  #follow({ image }) {
    const { sole } = this.#state;
    const beside = sole && nearestEdges(sole.cap, image, this.#pixels(ALONG_PX));
    if (!beside) return;
    const at = /** @type {Point} */ (beside.foot.map(hundredths));
    const last = this.#along.at(-1);
    if (!last || apart(last, at) >= this.#pixels(STEP_PX)) this.#along.push(at);
  }

  /** @type {(press: Press) => void} */
  up(press) {
    const [start, taken, along] = [this.#start, this.#taken, this.#along];
    this.#forget();
    if (!start) return;
    const clicked = apart(press.screen, start.screen) < CLICK_PX;
    if (taken && !clicked && along.length > 1) this.#change((cap) => called(cap, nextKind(taken.kind), along.flat()));
    else if (taken && clicked) this.#turn(taken);
    else if (clicked) this.#select(press);
  }

  /** @type {(arc: Arc) => void} */
  #turn(arc) {
    const kind = nextKind(arc.kind);
    const { fitted } = this.#state;
    this.#change((cap) => called(cap, kind, arc.points));
    // A second click goes on from here, also before the server has answered.
    const arcs = fitted?.arcs.map((each) => (each === arc ? { ...arc, kind, told: true } : each));
    if (fitted && arcs && this.#state.fitted === fitted) this.#state.fitted = { ...fitted, arcs };
  }

  /** @type {(change: (cap: Cap) => Cap) => void} */
  #change(change) {
    const { sole } = this.#state;
    if (sole) this.#state.commit([changed(sole, withCap(sole, change(sole.cap)))]);
  }

  /** @type {(press: Press) => void} */
  #select(press) {
    const state = this.#state;
    const item = state.at(press.image, this.#pixels(EDGE_PX));
    state.select(item ? [item.uid] : []);
    if (item?.cap.mark) this.#say(MARKED);
  }

  /** Takes back what was said of the piece under the pointer; nothing else is deleted with this tool. */
  back() {
    const arc = this.#at && this.#arcAt(this.#at);
    if (!arc) return false;
    if (arc.told) this.#change((cap) => uncalled(cap, arc.points));
    return true;
  }

  #forget() {
    this.#start = this.#taken = null;
    this.#along = [];
    this.#state.signals.overlay.emit();
  }

  leave() {
    this.#forget();
  }

  cancel() {
    const busy = this.#along.length > 1;
    this.#forget();
    return busy;
  }

  /** The names of the pieces, those that a person gave with a tick. @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const arcs = this.#state.explanation?.arcs ?? [];
    for (const arc of arcs) {
      const [x, y] = toScreen(view, ...middleOf(arc));
      writeCentred(context, arc.told ? `${ARCS[arc.kind].name} ✓` : ARCS[arc.kind].name, x, y + 6);
    }
    const under = this.#start ? null : this.#at && this.#arcAt(this.#at);
    const line = this.#along.length > 1 ? this.#along.flat() : (under?.points ?? []);
    if (line.length < 4) return arcs.length > 0;
    context.beginPath();
    traceRing(context, view, line, false);
    strokeCased(context, { colour: COLOURS.draft, width: 3, casing: CASING });
    return true;
  };
}
