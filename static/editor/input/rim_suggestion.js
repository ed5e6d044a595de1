/**
 * Shows where the rim lies near a cap that was just drawn by hand, until that is changed or another is selected. The
 * key that draws outlines to the rim takes it as it is shown.
 *
 * @module
 */

import { toScreen } from "../geometry/view.js";
import { CASING, COLOURS } from "../render/palette.js";
import { strokeCased, traceRing, writeCentred } from "../render/paths.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

const WORDS = "T: to the rim";

export class RimSuggestion {
  /** The cap that was drawn, its revision then, and the cap as its rim is. @type {{uid: string, revision: number, tight: Cap} | null} */
  #found = null;
  #state;
  #tightened;

  /**
   * @param {EditorState} state
   * @param {(shape: Shape) => Promise<Cap | null>} tightened
   */
  constructor(state, tightened) {
    this.#state = state;
    this.#tightened = tightened;
    state.signals.drawn.listen((shape) => void this.#look(shape));
  }

  /** @type {(shape: Shape) => Promise<void>} */
  async #look(shape) {
    this.#found = null;
    // The server may put an outline right as it stores it: that is no edit, and leaves the revision as it is.
    const { revision } = this.#state.shape(shape.uid) ?? shape;
    // Without the photo nothing is offered, and nobody has asked.
    const tight = await this.#tightened(shape).catch(() => null);
    this.#found = tight && { uid: shape.uid, revision, tight };
    this.#state.signals.overlay.emit();
  }

  /** What is offered for a cap as it is now. @type {(shape: Shape) => Cap | null} */
  of({ uid, revision }) {
    const found = this.#found;
    return found?.uid === uid && found.revision === revision ? found.tight : null;
  }

  /** @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const { sole } = this.#state;
    const tight = sole && this.of(sole);
    if (!tight) return false;
    context.beginPath();
    for (const ring of tight.visible) traceRing(context, view, ring);
    context.setLineDash([5, 4]);
    strokeCased(context, { colour: COLOURS.draft, width: 1.5, casing: CASING });
    context.setLineDash([]);
    const ring = tight.visible[0];
    const low = ring.reduce((most, value, i) => (i % 2 && value > ring[most] ? i : most), 1);
    const [x, y] = toScreen(view, ring[low - 1], ring[low]);
    writeCentred(context, WORDS, x, y + 14);
    return true;
  };
}
