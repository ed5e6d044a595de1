import { CLICK_PX, EDGE_PX, apart } from "./tool.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */

/** Two presses within this are a double click. */
const DOUBLE_MS = 500;

/** Which cap a click means: pressed again at one place, the next of those that lie there one under the other. */
export class Clicks {
  /** @type {{at: Point, time: number} | null} */
  #last = null;
  #state;

  /** @param {EditorState} state */
  constructor(state) {
    this.#state = state;
  }

  /** @type {(press: Press) => Shape | null} */
  meant(press) {
    const state = this.#state;
    const item = state.at(press.image, EDGE_PX / state.viewport.view.scale);
    const [before, now] = [this.#last, performance.now()];
    this.#last = { at: press.screen, time: now };
    if (press.shift || !before || apart(before.at, press.screen) > CLICK_PX) return item;
    // The second press of a double click means the same cap as the first.
    if (now - before.time < DOUBLE_MS) return state.sole ?? item;
    const all = state.allAt(press.image);
    const here = all.findIndex(({ uid }) => uid === state.selection.soleUid);
    return here < 0 ? item : all[(here + 1) % all.length];
  }
}
