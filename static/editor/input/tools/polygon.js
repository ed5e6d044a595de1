/**
 * Draws the visible outline of a new cap: click points, or drag to draw freehand. What is half drawn is kept
 * apart from the tool (`state/half_drawn.js`), so that taking up another tool loses nothing.
 *
 * @module
 */

import { boundsOfPoints } from "../../geometry/bounds.js";
import { areaOfRing, hundredths, newCap } from "../../geometry/caps.js";
import { pointsNeeded } from "../../geometry/points_needed.js";
import { areaOf } from "../../geometry/regions.js";
import { newShape, withCap } from "../../geometry/shapes.js";
import { comesRound, simplified } from "../../geometry/strokes.js";
import { FEWEST } from "../../geometry/vertices.js";
import { toScreen } from "../../geometry/view.js";
import { seenOf } from "../../geometry/what_is_seen.js";
import { newId } from "../../ids.js";
import { drawHalfDrawn } from "../../render/half_drawn.js";
import { writeCentred } from "../../render/paths.js";
import { changed } from "../../state/changes.js";
import { CLICK_PX, GRAB_PX, STRAYS_PX, apart } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */
/** @typedef {import("./tool.js").Tool} Tool */

/** Points drawn freehand lie so far apart, CSS pixels. */
const FREEHAND_PX = 5;
/** How far a double click may wander and still mean one point. */
const DOUBLE_PX = 8;
/** A held Ctrl+Z stops at the first point: so soon after it, it is not meant for what was done before. */
const STOPS_MS = 600;

/** What neighbours hide of a new cap is cut from it where it is more than this share: less is where borders meet. */
const LEAST_CUT = 0.005;
/** From this share on it is said: less is seen, and a sentence at every cap is read at none. */
const TOLD_CUT = 0.1;
const CUT = "Cut at its neighbours' borders: Ctrl+Z gives it back as drawn.";

/** @implements {Tool} */
export class PolygonTool {
  name = "polygon";
  cursor = "crosshair";
  /** The cap of which another part is drawn: a neighbour cuts it in two. @type {string | null} */
  partOf = null;
  /** @type {Point | null} */
  #next = null;
  #closing = false;
  /** Points that were there before the press; null while nothing is pressed. @type {number | null} */
  #before = null;
  /** Whether the last press placed a point. */
  #placed = false;
  /** When the last point was taken back. */
  #emptied = -Infinity;
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

  get #drawn() {
    return this.#state.halfDrawn;
  }

  /** @type {(press: Press) => void} */
  hover(press) {
    const { selection } = this.#state;
    this.#next = press.image;
    this.#closing = this.#closes(press);
    this.cursor = this.#closing ? "pointer" : "crosshair";
    const item = this.#drawn.empty ? this.#state.at(press.image, 0) : null;
    selection.hover(item && !selection.has(item.uid) ? item.uid : null);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => boolean} */
  #closes(press) {
    return this.#drawn.points.length >= FEWEST && this.#fromPoint(0, press) <= GRAB_PX;
  }

  /**
   * CSS pixels from a point that is drawn; infinitely many where there is none.
   *
   * @type {(index: number, press: Press) => number}
   */
  #fromPoint(index, press) {
    const point = this.#drawn.points.at(index);
    return point ? apart(toScreen(this.#state.viewport.view, ...point), press.screen) : Infinity;
  }

  /** @type {(press: Press) => void} */
  down(press) {
    const drawn = this.#drawn;
    if (drawn.empty && this.partOf === null) this.#state.select([]);
    this.#before = drawn.points.length;
    // The second press of a double click, or a hand that shakes, means the point that is there.
    this.#placed = this.#fromPoint(-1, press) > CLICK_PX;
    if (this.#closes(press)) this.finish();
    else if (this.#placed) this.#add(press);
  }

  /** @type {(press: Press) => void} */
  drag(press) {
    this.#next = press.image;
    if (this.#fromPoint(-1, press) >= FREEHAND_PX) this.#add(press);
    this.#state.signals.overlay.emit();
  }

  /** @type {(press: Press) => void} */
  #add({ image: [x, y] }) {
    const { width, height } = this.#state.image ?? { width: 0, height: 0 };
    this.#drawn.add([
      hundredths(Math.min(width, Math.max(0, x))),
      hundredths(Math.min(height, Math.max(0, y))),
    ]);
  }

  /**
   * Letting go near the start of a freehand outline, or after running on beyond it, closes it. Of what was drawn
   * freehand those points stay that the eye tells apart at this zoom.
   *
   * @type {(press: Press) => void}
   */
  up(press) {
    const before = this.#before;
    this.#before = null;
    const { points } = this.#drawn;
    if (before === null || points.length - before <= 2 * FEWEST) return;
    const { scale } = this.#state.viewport.view;
    const closed = this.#closes(press) || comesRound(points, GRAB_PX / scale);
    const first = Math.max(before - 1, 0);
    const stroke = simplified(points.slice(first), STRAYS_PX / scale);
    this.#drawn.begin([...points.slice(0, first), ...stroke]);
    if (closed) this.finish();
  }

  /** The second press of a double click may have shaken farther than a single one may. @type {() => void} */
  double() {
    const { points } = this.#drawn;
    const { view } = this.#state.viewport;
    const [last, before] = [points.at(-1), points.at(-2)];
    const far = last && before ? apart(toScreen(view, ...last), toScreen(view, ...before)) : Infinity;
    if (this.#placed && far <= DOUBLE_PX) this.#drawn.begin(points.slice(0, -1));
    this.finish();
  }

  /** A cap more, or a part more of one. @type {(ring: number[]) => import("../../state/changes.js").Change} */
  #changeBy(ring) {
    const cap = this.partOf === null ? null : this.#state.items.get(this.partOf);
    if (!cap) return { before: null, after: newShape(newId(), newCap({ visible: [ring] })) };
    return changed(cap, withCap(cap, { ...cap.cap, visible: [...cap.cap.visible, ring] }));
  }

  /**
   * A new cap ends where caps begin that lie in front of it, as one does that is drawn as a circle. That is a step
   * of its own, so that undo gives the outline back as it was drawn.
   *
   * @type {(drawn: import("../../geometry/shapes.js").Shape) => import("../../geometry/shapes.js").Shape}
   */
  #cutAtNeighbours(drawn) {
    const state = this.#state;
    const [ring] = drawn.cap.visible;
    const around = state.near(boundsOfPoints(ring)).filter(({ uid, cap }) => uid !== drawn.uid && !cap.ignored);
    const photo = state.image ?? { width: 0, height: 0 };
    const [whole, seen] = [[], around].map((others) => seenOf(ring, others, photo).visible);
    const before = state.items.get(drawn.uid);
    const hidden = areaOf(whole) - areaOf(seen);
    if (!before || seen.length === 0 || hidden < LEAST_CUT * areaOf(whole)) return drawn;
    const change = changed(before, withCap(before, { ...before.cap, visible: seen }));
    state.commit([change]);
    if (hidden >= TOLD_CUT * areaOf(whole)) this.#say(CUT);
    return change.after;
  }

  finish() {
    const { points } = this.#drawn;
    if (points.length === 0) return false;
    if (points.length < FEWEST) return true;
    const change = this.#changeBy(points.flat());
    this.#before = this.partOf = null;
    this.#drawn.begin([]);
    this.#state.commit([change]);
    const shape = change.before ? change.after : this.#cutAtNeighbours(change.after);
    this.#state.select([shape.uid]);
    this.#state.signals.draft.emit(shape);
    if (!change.before) this.#state.signals.drawn.emit(shape);
    return true;
  }

  back() {
    return !this.#drawn.empty && this.#drawn.undo();
  }

  undo() {
    const had = this.#drawn.undo();
    if (had && this.#drawn.empty) this.#emptied = performance.now();
    return had || performance.now() - this.#emptied < STOPS_MS;
  }

  redo() {
    return this.#drawn.redo() || !this.#drawn.empty;
  }

  cancel() {
    const busy = !this.#drawn.empty;
    this.#drawn.drop();
    this.#before = this.#next = this.partOf = null;
    this.#state.signals.overlay.emit();
    return busy;
  }

  leave() {
    if (this.#drawn.empty) {
      this.#drawn.begin([]);
      this.partOf = null;
    }
    this.#before = this.#next = null;
    this.#state.signals.overlay.emit();
  }

  /** @type {import("../../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const { points } = this.#drawn;
    if (points.length === 0) return false;
    const next = this.#next ?? points[points.length - 1];
    drawHalfDrawn(context, view, { points, next, closing: this.#closing });
    const needed = pointsNeeded(areaOfRing(points.flat()));
    const [x, y] = toScreen(view, ...next);
    if (points.length >= FEWEST && points.length < needed)
      writeCentred(context, `${points.length} of ${needed} points`, x, y + 14);
    return true;
  };

  /** The same while another tool is in hand. @type {import("../../render/overlay.js").Sketch} */
  resting = (context, view) => {
    const { points } = this.#drawn;
    if (points.length) drawHalfDrawn(context, view, { points, next: null, closing: false });
    return points.length > 0;
  };
}
