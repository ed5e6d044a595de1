/**
 * Keeps the whole outline of the one selected cap up to date while the cap is changed.
 *
 * @module
 */

import { placedWhole } from "../geometry/caps.js";
import { FitRequests } from "./fit_requests.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Fitted} Fitted */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

export class LiveFit {
  /** What the last question was about. @type {Cap | null} */
  #asked = null;
  #state;
  #requests;
  #told;

  /**
   * @param {EditorState} state
   * @param {Object} wires
   * @param {(message: ToServer) => boolean} wires.send
   * @param {(explanation: Fitted | null) => void} wires.told  how the outline at hand came about, if that is known
   */
  constructor(state, { send, told }) {
    this.#state = state;
    this.#requests = new FitRequests(send);
    this.#told = told;
    state.signals.draft.listen((shape) => this.#ask(shape));
    state.signals.shapes.listen(() => this.#look());
    state.signals.selection.listen(() => this.#look());
  }

  /** Nothing that was asked is waited for any longer. */
  forget() {
    this.#requests.forget();
    this.#asked = null;
  }

  /** @type {(fitted: Fitted) => void} */
  take(fitted) {
    const state = this.#state;
    if (!this.#requests.take(fitted)) return;
    const draft = state.drafts.get(fitted.annotation);
    if (draft) state.drafts.put({ ...draft, whole: fitted.fit.whole, centre: fitted.fit.centre });
    state.fitted = fitted;
    this.#told(state.explanation);
    state.signals.overlay.emit();
  }

  #look() {
    const { sole, explanation } = this.#state;
    if (sole) this.#ask(sole);
    else this.#asked = null;
    this.#told(explanation);
  }

  /** @type {(shape: Shape) => void} */
  #ask({ uid, cap }) {
    const image = this.#state.image?.id;
    if (image === undefined || cap === this.#asked || placedWhole(cap)) return;
    this.#asked = cap;
    this.#requests.ask({ image, annotation: uid, cap });
  }
}
