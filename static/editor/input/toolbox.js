/**
 * The tools, one of which is in hand.
 *
 * @module
 */

import { ArcsTool } from "./tools/arcs.js";
import { Broom } from "./tools/broom.js";
import { CircleTool } from "./tools/circle.js";
import { panTool } from "./tools/pan.js";
import { PointTool } from "./tools/point.js";
import { PolygonTool } from "./tools/polygon.js";
import { rimTool } from "./tools/rim.js";
import { RimPointsTool } from "./tools/rim_points.js";
import { SelectTool } from "./tools/select.js";
import { splitTool } from "./tools/split.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tools/tool.js").Tool} Tool */

const WHICH_CAP = "Select the cap first that another part is to be drawn of.";
const ANOTHER_PART = "Draw another part of the cap.";
const STAYS_HALF_DRAWN = "The outline stays half drawn: W goes on with it, Enter closes it.";

export class Toolbox {
  /** @type {Record<string, Tool>} */
  #tools;
  #polygon;
  #state;
  #changed;
  #say;
  #broom;
  /** The tool that was in hand before a key was held that stands for another. @type {Tool | null} */
  #before = null;
  /** The tool in hand. @type {Tool} */
  tool;

  /**
   * @param {EditorState} state
   * @param {Object} rest
   * @param {() => void} rest.changed  another tool is in hand
   * @param {(text: string) => void} rest.say
   * @param {import("./tools/point.js").Network} rest.network
   */
  constructor(state, { changed, say, network }) {
    this.#state = state;
    this.#changed = changed;
    this.#say = say;
    this.#polygon = new PolygonTool(state, say);
    this.#broom = new Broom(state);
    const rim = rimTool(state, say);
    this.#tools = {
      select: new SelectTool(state, { say, rim }),
      polygon: this.#polygon,
      circle: new CircleTool(state),
      rim_points: new RimPointsTool(state),
      rim,
      split: splitTool(state, say),
      point: new PointTool(state, say, network),
      arcs: new ArcsTool(state, say),
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

  /** Ends what the tool in hand has half done, else closes the outline that is half drawn. */
  finish() {
    if (!this.tool.finish?.()) this.#polygon.finish();
  }

  /** Draws another part of the selected cap. */
  drawPart() {
    const { sole } = this.#state;
    if (!sole) return this.#say(WHICH_CAP);
    this.use("polygon");
    this.#polygon.partOf = sole.uid;
    this.#say(ANOTHER_PART);
  }

  /** As long as a key is held the broom is in hand; let go, it deletes what it has swept. @type {(held: boolean) => void} */
  sweep(held) {
    if (held === (this.#before !== null)) return;
    if (held) {
      this.#state.commitDrafts();
      this.#before = this.tool;
      this.tool = this.#broom;
    } else {
      this.#broom.leave();
      this.tool = this.#before ?? this.tool;
      this.#before = null;
    }
    this.#changed();
  }

  /** Takes up another tool; what is half drawn stays, and can be gone on with. @type {(name: string) => void} */
  use(name) {
    if (!Object.hasOwn(this.#tools, name) || this.tool.name === name) return;
    this.sweep(false);
    this.leave();
    if (this.tool.name === "polygon" && !this.#state.halfDrawn.empty) this.#say(STAYS_HALF_DRAWN);
    this.tool = this.#tools[name];
    this.#state.selection.hover(null);
    this.tool.begin?.();
    this.#changed();
  }
}
