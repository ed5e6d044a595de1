/**
 * Shows where the rim lies near a cap that is being drawn out by hand, and near one that was just drawn, until that is
 * changed or another is selected. The key that draws outlines to the rim takes it as it is shown then.
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
  /** The cap that is being drawn out. @type {Shape | null} */
  #drawing = null;
  /** That cap, or as it was a moment ago, as its rim is. @type {Cap | null} */
  #tightOfDrawing = null;
  #following = false;
  #state;
  #tightened;
  #tightenedByPhoto;

  /**
   * @param {EditorState} state
   * @param {Object} how
   * @param {(shape: Shape) => Promise<Cap | null>} how.tightened
   * @param {(shape: Shape) => Promise<Cap | null>} how.tightenedByPhoto  without asking the network, which takes too long for every move
   */
  constructor(state, { tightened, tightenedByPhoto }) {
    this.#state = state;
    this.#tightened = tightened;
    this.#tightenedByPhoto = tightenedByPhoto;
    state.signals.drawing.listen((shape) => void this.#follow(shape));
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

  /** What is shown: of the cap that is being drawn out, else of the one that is selected. */
  get shown() {
    const { sole } = this.#state;
    return this.#tightOfDrawing ?? (sole && this.of(sole));
  }

  /** Looks at the cap as it is now, and no more often than it can. @type {(shape: Shape | null) => Promise<void>} */
  async #follow(shape) {
    this.#drawing = shape;
    if (!shape) this.#tightOfDrawing = null;
    if (this.#following) return;
    this.#following = true;
    let looked = null;
    while (this.#drawing && this.#drawing !== looked) {
      looked = this.#drawing;
      const tight = await this.#tightenedByPhoto(looked).catch(() => null);
      this.#tightOfDrawing = this.#drawing && tight;
      this.#state.signals.overlay.emit();
    }
    this.#following = false;
  }

  /** What is offered for a cap as it is now. @type {(shape: Shape) => Cap | null} */
  of({ uid, revision }) {
    const found = this.#found;
    return found?.uid === uid && found.revision === revision ? found.tight : null;
  }

  /** @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const tight = this.shown;
    if (!tight) return false;
    context.beginPath();
    for (const ring of tight.visible) traceRing(context, view, ring);
    context.setLineDash([5, 4]);
    strokeCased(context, { colour: COLOURS.draft, width: 1.5, casing: CASING });
    context.setLineDash([]);
    if (this.#tightOfDrawing) return true;
    const ring = tight.visible[0];
    const low = ring.reduce((most, value, i) => (i % 2 && value > ring[most] ? i : most), 1);
    const [x, y] = toScreen(view, ring[low - 1], ring[low]);
    writeCentred(context, WORDS, x, y + 14);
    return true;
  };
}
