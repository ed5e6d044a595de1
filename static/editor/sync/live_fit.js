/**
 * Keeps the whole outline of the cap at hand up to date, and says how it came about.
 *
 * @module
 */

import { captionIn } from "../ui/caption.js";
import { placedWhole } from "../geometry/caps.js";
import { Refits } from "./fit_requests.js";

/** @typedef {import("../state/desk.js").Desk} Desk */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Fit} Fit */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/store.js").Shape} Shape */

export class Fitting {
  /** What the last question was about. @type {Cap | null} */
  #asked = null;
  #desk;
  #refits;
  #caption;

  /**
   * @param {HTMLElement} host
   * @param {Desk} desk
   * @param {(message: ToServer) => boolean} send
   */
  constructor(host, desk, send) {
    this.#desk = desk;
    this.#refits = new Refits(send);
    this.#caption = captionIn(host);
    desk.signals.draft.listen((shape) => this.#ask(shape));
    desk.signals.shapes.listen(() => this.#look());
    desk.signals.selection.listen(() => this.#look());
  }

  /** Nothing that was asked is waited for any longer. */
  forget() {
    this.#refits.forget();
    this.#asked = null;
  }

  /** @type {(fit: Fit) => void} */
  take(fit) {
    const desk = this.#desk;
    if (!this.#refits.take(fit)) return;
    const draft = desk.drafts.get(fit.annotation);
    if (draft) desk.drafts.set(fit.annotation, { ...draft, whole: fit.whole, centre: fit.centre });
    desk.fitting = fit;
    this.#caption(desk.explanation);
    desk.signals.overlay.emit();
  }

  #look() {
    const { sole } = this.#desk;
    if (sole) this.#ask(sole);
    else this.#asked = null;
    this.#caption(this.#desk.explanation);
  }

  /** @type {(shape: Shape) => void} */
  #ask({ uid, cap }) {
    const image = this.#desk.image?.id;
    if (image === undefined || cap === this.#asked || placedWhole(cap)) return;
    this.#asked = cap;
    this.#refits.ask({ image, annotation: uid, cap });
  }
}
