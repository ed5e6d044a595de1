/**
 * From which score on predictions are accepted: a slider with a live count, while those that are meant are drawn.
 *
 * @module
 */

import { CASING, COLOURS, FILLS } from "../render/palette.js";
import { strokeCased, traceCap } from "../render/paths.js";
import { atLeast } from "../state/walking.js";
import { element } from "./dom.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

export class Threshold {
  /** What was chosen last. */
  #score = 0.5;
  /** Those that are meant so far. @type {Shape[]} */
  #meant = [];
  #state;

  /** @param {EditorState} state */
  constructor(state) {
    this.#state = state;
  }

  /** Enter takes the score, Escape does not. @returns {Promise<number | null>} */
  ask() {
    const slider = sliderAt(this.#score);
    const words = element("p", { attributes: { "aria-live": "polite" } });
    const yes = element("button", { attributes: { type: "submit", value: "yes" } });
    const dialog = dialogOf(words, slider, yes);
    const update = () => {
      const [found, all] = [this.#mean(slider.valueAsNumber), atLeast(this.#state, 0).length];
      words.textContent = `Score ${slider.valueAsNumber.toFixed(2)} and more: ${found} of ${all} open predictions`;
      yes.textContent = `Accept ${found}`;
    };
    slider.addEventListener("input", update);
    return new Promise((resolve) => {
      dialog.addEventListener("close", () => {
        dialog.remove();
        this.#mean(null);
        if (dialog.returnValue !== "yes") return resolve(null);
        this.#score = slider.valueAsNumber;
        resolve(this.#score);
      });
      document.body.append(dialog);
      update();
      dialog.showModal();
    });
  }

  /** Draws those of at least this score. @type {(score: number | null) => number} how many they are */
  #mean(score) {
    this.#meant = score === null ? [] : atLeast(this.#state, score);
    this.#state.signals.overlay.emit();
    return this.#meant.length;
  }

  /** @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    context.beginPath();
    for (const { cap } of this.#meant) traceCap(context, view, cap);
    context.fillStyle = FILLS.outline;
    context.fill();
    strokeCased(context, { colour: COLOURS.outline, width: 1.5, casing: CASING });
    return this.#meant.length > 0;
  };
}

/** @type {(score: number) => HTMLInputElement} */
function sliderAt(score) {
  const slider = element("input", {
    attributes: { type: "range", min: "0", max: "1", step: "0.05", "aria-label": "Least score", autofocus: "" },
  });
  slider.value = String(score);
  return slider;
}

/** @type {(words: HTMLElement, slider: HTMLElement, yes: HTMLElement) => HTMLDialogElement} */
function dialogOf(words, slider, yes) {
  const no = element("button", { text: "Cancel", attributes: { type: "submit", value: "no" } });
  const form = element("form", { attributes: { method: "dialog" } }, words, slider, element("div", {}, no, yes));
  const attributes = { "aria-label": "Accept predictions" };
  const dialog = element("dialog", { class: "fairyring-threshold", attributes }, form);
  // Enter in a field would press the first button of its form.
  slider.addEventListener("keydown", (event) => {
    if (event.key !== "Enter") return;
    event.preventDefault();
    dialog.close("yes");
  });
  return dialog;
}
