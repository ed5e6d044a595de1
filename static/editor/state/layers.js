/**
 * What is drawn of the image.
 *
 * @module
 */

import DECLARED from "../commands.js";
import { isPrediction } from "../geometry/shapes.js";
import { signal } from "./signal.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */

export class Layers {
  /** By name. @type {Record<string, boolean>} */
  #visible = Object.fromEntries(DECLARED.layers.map(({ name, shown }) => [name, shown]));
  /** A key is held that hides all caps for a moment. */
  allHidden = false;
  /** @type {import("./signal.js").Signal<[]>} */
  changed = signal();

  get visible() {
    return this.#visible;
  }

  set visible(visible) {
    this.#visible = visible;
    this.changed.emit();
  }

  /**
   * Whether anything of a shape is drawn. What is ignored always is, so that nobody takes it for bare ground.
   *
   * @param {Shape} shape
   * @returns {boolean}
   */
  show(shape) {
    const { cap, whole, centre } = shape;
    const { prediction, outline, fill, whole: wholes, centre: centres } = this.#visible;
    if (isPrediction(shape)) return prediction;
    if (cap.ignored || (cap.visible.length > 0 && (outline || fill))) return true;
    return (wholes && (whole !== null || cap.mark !== null)) || (centres && centre !== null);
  }

  /** Shows a layer that is hidden, hides one that is shown. @type {(name: string) => void} */
  toggle(name) {
    this.visible = { ...this.visible, [name]: !this.visible[name] };
  }
}
