/**
 * Edits that the server refused: which cap and why, and what was refused, drawn on the photo until the sentence
 * is closed.
 *
 * @module
 */

import { isOfCap } from "../sync/outbox.js";
import { CASING, COLOURS } from "../render/palette.js";
import { strokeCased, traceCap } from "../render/paths.js";

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../sync/outbox.js").CapEdit} CapEdit */
/** @typedef {import("../sync/outbox.js").Edit} Edit */

/**
 * @typedef {Object} Parts
 * @property {import("./notices.js").Say} say
 * @property {(image: number, uid: string) => void} show  opens the image and brings the cap into view
 * @property {() => number} image  the one on screen
 * @property {() => void} redraw
 */

export class Refusals {
  /** @type {Set<CapEdit>} */
  #told = new Set();
  #parts;

  /** @param {Parts} parts */
  constructor(parts) {
    this.#parts = parts;
  }

  /** @type {(edit: Edit, reason: string) => void} */
  tell(edit, reason) {
    const { say, show, image, redraw } = this.#parts;
    if (!isOfCap(edit)) return say(reason, "error", { about: "decision" });
    this.#told.add(edit);
    redraw();
    const where = edit.image === image() ? "a cap of this image" : "a cap of another image";
    say(`A change of ${where} was not stored: ${reason}`, "error", {
      word: "Show it",
      act: () => show(edit.image, edit.annotation),
      closed: () => {
        this.#told.delete(edit);
        redraw();
      },
    });
  }

  /** What was refused on the image on screen. @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const image = this.#parts.image();
    const caps = [...this.#told].flatMap(({ image: its, cap }) => (its === image && cap ? cap : []));
    for (const cap of caps) {
      context.beginPath();
      traceCap(context, view, cap);
      context.setLineDash([2, 4]);
      strokeCased(context, { colour: COLOURS.refused, width: 2, casing: CASING });
      context.setLineDash([]);
    }
    return caps.length > 0;
  };
}
