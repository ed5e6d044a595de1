/**
 * The tools, one of which is in hand.
 *
 * @module
 */

import { CircleTool } from "./tools/circle.js";
import { panTool } from "./tools/pan.js";
import { PolygonTool } from "./tools/polygon.js";
import { SelectTool } from "./tools/select.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Tool} Tool */

export class Toolbox {
  /** @type {Record<string, Tool>} */
  #tools;
  #state;
  #changed;
  /** The tool in hand. @type {Tool} */
  tool;

  /**
   * @param {EditorState} state
   * @param {() => void} changed  another tool is in hand
   */
  constructor(state, changed) {
    this.#state = state;
    this.#changed = changed;
    this.#tools = {
      select: new SelectTool(state),
      polygon: new PolygonTool(state, () => this.use("select")),
      circle: new CircleTool(state),
      pan: panTool(state),
    };
    this.tool = this.#tools.select;
  }

  /** Takes up another tool. @type {(name: string) => void} */
  use(name) {
    if (!Object.hasOwn(this.#tools, name) || this.tool.name === name) return;
    this.tool.cancel();
    this.#state.commitDrafts();
    this.tool = this.#tools[name];
    this.#state.selection.hover(null);
    this.#changed();
  }
}
