/**
 * The tools, one of which is in hand.
 *
 * @module
 */

import { CircleTool } from "./tools/circle.js";
import { panTool } from "./tools/pan.js";
import { PolygonTool } from "./tools/polygon.js";
import { SelectTool } from "./tools/select.js";

/** @typedef {import("../state/desk.js").Desk} Desk */
/** @typedef {import("./tools/tool.js").Tool} Tool */

export class Toolbox {
  /** @type {Record<string, Tool>} */
  #tools;
  #desk;
  #changed;
  /** The tool in hand. @type {Tool} */
  tool;

  /**
   * @param {Desk} desk
   * @param {() => void} changed  another tool is in hand
   */
  constructor(desk, changed) {
    this.#desk = desk;
    this.#changed = changed;
    this.#tools = {
      select: new SelectTool(desk),
      polygon: new PolygonTool(desk, () => this.use("select")),
      circle: new CircleTool(desk),
      pan: panTool(desk),
    };
    this.tool = this.#tools.select;
  }

  /** Takes up another tool. @type {(name: string) => void} */
  use(name) {
    if (!Object.hasOwn(this.#tools, name) || this.tool.name === name) return;
    this.tool.cancel();
    this.#desk.settle();
    this.tool = this.#tools[name];
    this.#desk.hover(null);
    this.#changed();
  }
}
