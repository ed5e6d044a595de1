/**
 * The tools, one of which is in hand.
 *
 * @module
 */

import { CircleTool } from "./tools/circle.js";
import { panTool } from "./tools/pan.js";
import { PolygonTool } from "./tools/polygon.js";
import { RimTool } from "./tools/rim.js";
import { SelectTool } from "./tools/select.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Tool} Tool */

const STAYS_HALF_DRAWN = "The outline stays half drawn: W goes on with it, Enter closes it.";

export class Toolbox {
  /** @type {Record<string, Tool>} */
  #tools;
  #polygon;
  #state;
  #changed;
  #say;
  /** The tool in hand. @type {Tool} */
  tool;

  /**
   * @param {EditorState} state
   * @param {Object} rest
   * @param {() => void} rest.changed  another tool is in hand
   * @param {(text: string) => void} rest.say
   */
  constructor(state, { changed, say }) {
    this.#state = state;
    this.#changed = changed;
    this.#say = say;
    this.#polygon = new PolygonTool(state, () => this.use("select"));
    const rim = new RimTool(state, say);
    this.#tools = {
      select: new SelectTool(state, { say, rim }),
      polygon: this.#polygon,
      circle: new CircleTool(state),
      rim,
      pan: panTool(state),
    };
    this.tool = this.#tools.select;
  }

  /** What the tools draw over the photo: the one in hand, and what another has left half drawn. */
  get sketches() {
    const own = this.tool.sketch ?? (() => false);
    return this.tool === this.#polygon ? [own] : [own, this.#polygon.resting];
  }

  /** Something else comes: what is half done is finished or kept. */
  leave() {
    this.tool.leave();
    this.#state.commitDrafts();
    this.#changed();
  }

  /** Closes the outline that is half drawn, whichever tool is in hand. */
  finish() {
    this.#polygon.finish();
  }

  /** Takes up another tool; what is half drawn stays, and can be gone on with. @type {(name: string) => void} */
  use(name) {
    if (!Object.hasOwn(this.#tools, name) || this.tool.name === name) return;
    this.leave();
    if (this.tool.name === "polygon" && !this.#state.halfDrawn.empty) this.#say(STAYS_HALF_DRAWN);
    this.tool = this.#tools[name];
    this.#state.selection.hover(null);
    this.#changed();
  }
}
