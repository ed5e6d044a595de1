/**
 * Shows the cap that the network sees under the pointer, dashed, where nobody has labelled one. A click takes it; with
 * Shift a further click adds to it, with Alt one takes away. A box around a hard one asks for that.
 *
 * @module
 */

import { hundredths, insideCap, newCap } from "../../geometry/caps.js";
import { newShape, withCap } from "../../geometry/shapes.js";
import { toScreen } from "../../geometry/view.js";
import { newId } from "../../ids.js";
import { CASING, COLOURS, FILLS } from "../../render/palette.js";
import { strokeCased, traceRing, writeCentred } from "../../render/paths.js";
import { changed } from "../../state/changes.js";
import { LOOK } from "../../sync/cap_requests.js";
import { drawBand } from "./band.js";
import { CLICK_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").FoundCap} FoundCap */
/** @typedef {import("../../protocol.js").Outline} Outline */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */
/** @typedef {{points: Point[], wanted: boolean[], box: [number, number, number, number] | null}} Question */

/**
 * @typedef {Object} Network
 * @property {(question: Question, how: {keep: boolean}) => Promise<FoundCap | null>} ask  null: no answer is to come
 * @property {() => boolean} busy
 */

/** The pointer rests when it has not moved for so long; while it moves, the browser tells of it every 17 ms. */
const RESTS_MS = 20;
/** From so long on it is said that the network is still at it. */
const LONG_MS = 300;

const NONE_THERE = "The network sees no cap there. A box around it may tell, or C draws it.";

/** @implements {Tool} */
export class PointTool {
  name = "point";
  cursor = "crosshair";
  /** What would be taken. @type {{visible: Outline, score: number} | null} */
  #preview = null;
  /** The cap that was taken last, and the points that tell of it. @type {{uid: string, points: Point[], wanted: boolean[]} | null} */
  #taken = null;
  /** @type {Press | null} */
  #start = null;
  /** @type {Press | null} */
  #at = null;
  #timer = 0;
  /** When the question that waits was asked. */
  #askedAt = 0;
  #state;
  #network;
  #say;

  /**
   * @param {EditorState} state
   * @param {(text: string) => void} say
   * @param {Network} network
   */
  constructor(state, say, network) {
    this.#state = state;
    this.#say = say;
    this.#network = network;
  }

  /** The tool is taken up: the network looks at the photo before it is asked. */
  begin() {
    void this.#ask(LOOK, { keep: false });
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    const item = this.#state.at(press.image, 0);
    this.#at = press;
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
    if (this.#preview && !insideCap(newCap({ visible: this.#preview.visible }), ...press.image)) this.#preview = null;
    this.cursor = item ? "pointer" : "crosshair";
    clearTimeout(this.#timer);
    const rested = performance.now() - press.time;
    if (!item) this.#timer = setTimeout(() => void this.#look(press), RESTS_MS - rested);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => Promise<void>} */
  async #look(press) {
    const found = await this.#ask({ points: [pointOf(press)], wanted: [true], box: null }, { keep: false });
    if (!found || this.#at !== press || this.#start) return;
    this.#preview = found.visible && { visible: found.visible, score: found.score ?? 0 };
    this.#state.signals.overlay.emit();
  }

  /** @type {(question: Question, how: {keep: boolean}) => Promise<FoundCap | null>} */
  async #ask(question, how) {
    this.#askedAt = performance.now();
    setTimeout(() => this.#state.signals.overlay.emit(), LONG_MS + 10);
    const found = await this.#network.ask(question, how);
    this.#state.signals.overlay.emit();
    return found?.image === this.#state.image?.id ? found : null;
  }

  /** @type {(press: Press) => void} */
  down(press) {
    this.#state.commitDrafts();
    clearTimeout(this.#timer);
    this.#start = this.#at = press;
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    this.#at = press;
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  up(press) {
    const start = this.#start;
    this.#start = null;
    if (!start) return;
    if (apart(start.screen, press.screen) >= CLICK_PX) void this.#take({ points: [], wanted: [], box: boxOf(start, press) });
    else if (press.shift || press.alt) void this.#refine(press);
    else this.#click(press);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  #click(press) {
    const item = this.#state.at(press.image, 0);
    if (item) {
      this.#taken = null;
      return this.#state.select([item.uid]);
    }
    const question = { points: [pointOf(press)], wanted: [true], box: null };
    const preview = this.#preview;
    if (preview) this.#put(preview.visible, question);
    else void this.#take(question);
  }

  /** @type {(question: Question) => Promise<void>} */
  async #take(question) {
    const found = await this.#ask(question, { keep: true });
    if (found?.visible) this.#put(found.visible, question);
    else if (found) this.#say(NONE_THERE);
  }

  /** @type {(visible: Outline, question: Question) => void} */
  #put(visible, { points, wanted }) {
    this.#preview = null;
    const after = newShape(newId(), newCap({ visible }));
    this.#state.commit([{ before: null, after }]);
    this.#state.select([after.uid]);
    this.#state.signals.draft.emit(after);
    this.#taken = { uid: after.uid, points, wanted };
  }

  /** A further point says what belongs to the cap that was taken, or does not. @type {(press: Press) => Promise<void>} */
  async #refine(press) {
    const taken = this.#taken;
    const shape = taken && this.#state.items.get(taken.uid);
    if (!taken || !shape || (taken.points.length === 0 && press.alt)) return;
    const points = [...taken.points, pointOf(press)];
    const wanted = [...taken.wanted, !press.alt];
    this.#taken = { ...taken, points, wanted };
    const found = await this.#ask({ points, wanted, box: null }, { keep: true });
    const now = this.#state.items.get(taken.uid);
    if (found?.visible && now) this.#state.commit([changed(now, withCap(now, { ...now.cap, visible: found.visible }))]);
    else if (found) this.#say(NONE_THERE);
  }

  cancel() {
    const busy = this.#start !== null;
    this.#forget();
    return busy;
  }

  leave() {
    this.#taken = null;
    this.#forget();
  }

  #forget() {
    clearTimeout(this.#timer);
    this.#start = this.#preview = this.#at = null;
    this.#state.signals.overlay.emit();
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const [start, at, preview] = [this.#start, this.#at, this.#preview];
    if (start && at && apart(start.screen, at.screen) >= CLICK_PX) {
      const [x0, y0, x1, y1] = boxOf(start, at);
      drawBand(context, view, { from: [x0, y0], to: [x1, y1] });
    } else if (preview) drawPreview(context, view, preview);
    const late = this.#network.busy() && performance.now() - this.#askedAt > LONG_MS;
    if (late && at) writeCentred(context, "the network is looking…", at.screen[0], at.screen[1] + 16);
    return Boolean(preview || start || (late && at));
  };
}

/** @type {(context: CanvasRenderingContext2D, view: import("../../geometry/view.js").View, preview: {visible: Outline, score: number}) => void} */
function drawPreview(context, view, { visible, score }) {
  context.beginPath();
  for (const ring of visible) traceRing(context, view, ring);
  context.fillStyle = FILLS.prediction;
  context.fill();
  context.setLineDash([5, 4]);
  strokeCased(context, { colour: COLOURS.draft, width: 2, casing: CASING });
  context.setLineDash([]);
  const low = visible[0].reduce((most, value, i) => (i % 2 ? Math.max(most, value) : most), -Infinity);
  const [x, y] = toScreen(view, visible[0][0], low);
  writeCentred(context, score.toFixed(2), x, y + 4);
}

/** @type {(press: Press) => Point} */
function pointOf({ image: [x, y] }) {
  return [hundredths(x), hundredths(y)];
}

/** @type {(from: Press, to: Press) => [number, number, number, number]} */
function boxOf({ image: [fx, fy] }, { image: [tx, ty] }) {
  return [Math.min(fx, tx), Math.min(fy, ty), Math.max(fx, tx), Math.max(fy, ty)];
}
