/** Whoever stays on an image so long may want to point at its caps; whoever only leafs through does not. */
const STAYS_MS = 1500;

/**
 * Has the network look at a photo on which somebody stays, but not while a cap is in hand: it would keep the fits of
 * that waiting.
 */
export class LookSoon {
  #timer = 0;
  #state;
  #look;

  /**
   * @param {import("../state/editor_state.js").EditorState} state
   * @param {() => void} look
   */
  constructor(state, look) {
    this.#state = state;
    this.#look = look;
  }

  /** A photo is shown. */
  begin() {
    this.stop();
    this.#timer = setTimeout(() => (this.#state.drafts.all.length ? this.begin() : this.#look()), STAYS_MS);
  }

  /** It is left. */
  stop() {
    clearTimeout(this.#timer);
  }
}
