/**
 * Takes vertices, and lesser parts, out of the selected cap. Delete, pressed once more at the same place, takes out
 * what is there then and never the cap.
 *
 * @module
 */

import { areaOfRing, insideRing } from "../../geometry/caps.js";
import { withCap } from "../../geometry/shapes.js";
import { removedVertices } from "../../geometry/vertices.js";
import { toImage } from "../../geometry/view.js";
import { changed } from "../../state/changes.js";
import { apart } from "./tool.js";

/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */

/** So near to where something was taken out, CSS pixels, Delete never means the cap. */
const STILL_HERE_PX = 30;

const TAKEN_OUT = "Something was taken out here. To delete the cap, move the pointer away first.";
const NONE_TO_SPARE = "An outline needs three points. To delete the cap, move the pointer away first.";

export class Removal {
  /** Where something was taken out last, CSS pixels, and of which cap. @type {{at: Point, uid: string} | null} */
  #last = null;
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

  /** The pointer is somewhere else. @type {(at: Point) => void} */
  moved(at) {
    if (this.#last && apart(this.#last.at, at) > STILL_HERE_PX) this.#last = null;
  }

  forget() {
    this.#last = null;
  }

  /** Takes the vertex out that the pointer is on. @type {(handle: Handle | null, at: Point) => boolean} whether it is on one */
  remove(handle, at) {
    const { selection, sole } = this.#state;
    if (!sole || handle?.kind !== "vertex") return false;
    const cap = removedVertices(sole.cap, handle.vertices);
    selection.activate(null);
    if (cap) this.#state.commit([changed(sole, { ...sole, cap })]);
    else this.#say(NONE_TO_SPARE);
    this.#wasHere(at);
    return true;
  }

  /** Takes the part out that lies at a place of the screen, unless it is the largest. @type {(at: Point) => boolean} whether there is one */
  removePart(at) {
    const { sole, viewport } = this.#state;
    if (!sole || sole.cap.visible.length < 2) return false;
    const { visible } = sole.cap;
    const here = toImage(viewport.view, ...at);
    const part = visible.find((ring) => insideRing(ring, ...here));
    if (!part || areaOfRing(part) >= Math.max(...visible.map(areaOfRing))) return false;
    const cap = { ...sole.cap, visible: visible.filter((ring) => ring !== part) };
    this.#state.commit([changed(sole, withCap(sole, cap))]);
    this.#wasHere(at);
    return true;
  }

  /** @type {(at: Point) => void} */
  #wasHere(at) {
    // A prediction has become an annotation by this.
    const uid = this.#state.selection.soleUid;
    this.#last = uid === null ? null : { at, uid };
  }

  /** Whether the selected cap is safe, as something of it was taken out here; says so. */
  keepsCap() {
    if (!this.#last || this.#last.uid !== this.#state.selection.soleUid) return false;
    this.#say(TAKEN_OUT);
    return true;
  }
}
