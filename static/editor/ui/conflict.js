/**
 * A lost update that was not lost: shows both caps on the photo and lets the person choose.
 *
 * @module
 */

import { placedWhole } from "../geometry/caps.js";
import { element } from "./dom.js";
import { CASING, COLOURS } from "../render/palette.js";
import { strokeCased, traceRing, traceWhole } from "../render/paths.js";
import { shapeOfAnnotation } from "../state/store.js";

/** @typedef {import("../sync/sync.js").Clash} Clash */

/**
 * @typedef {Object} Wishes
 * @property {(clash: Clash, whose: "mine" | "theirs") => void} resolve
 * @property {(clash: Clash) => void} show  brings the cap into view
 */

export class ConflictCard {
  /** @type {Clash | null} */
  #clash = null;
  #card = element("div", {
    class: "fairyring-conflict",
    attributes: { role: "alertdialog", "aria-label": "Conflict" },
  });
  #wishes;

  /**
   * @param {HTMLElement} host
   * @param {Wishes} wishes
   */
  constructor(host, wishes) {
    this.#wishes = wishes;
    this.#card.dataset.fairyringChrome = "";
    this.#card.hidden = true;
    host.append(this.#card);
  }

  /**
   * @param {Clash[]} clashes
   * @param {number} image the one on screen
   */
  update(clashes, image) {
    const clash = clashes.find((other) => other.image === image) ?? clashes[0] ?? null;
    if (clash === this.#clash && this.#card.dataset.image === String(image)) return;
    const fresh = clash !== this.#clash;
    this.#clash = clash;
    this.#card.hidden = clash === null;
    this.#card.dataset.image = String(image);
    if (!clash) return;
    this.#card.replaceChildren(...this.#content(clash, clashes.length, clash.image === image));
    if (fresh && clash.image === image) this.#wishes.show(clash);
  }

  /** @type {(clash: Clash, count: number, here: boolean) => Node[]} */
  #content(clash, count, here) {
    const did = clash.theirs.deleted ? "deleted" : "changed";
    const more = count > 1 ? ` (1 of ${count})` : "";
    const where = here ? "this cap" : "a cap on another image";
    const text = `${clash.user} ${did} ${where} while you were changing it.${more}`;
    const legend = element(
      "p",
      { class: "fairyring-conflict-legend" },
      element("span", { class: "is-mine", text: "yours" }),
      element("span", {
        class: "is-theirs",
        text: clash.theirs.deleted ? `${clash.user}: deleted` : clash.user,
      }),
    );
    const { resolve, show } = this.#wishes;
    const buttons = here
      ? [
          button("Keep mine", () => resolve(clash, "mine")),
          button("Take theirs", () => resolve(clash, "theirs")),
        ]
      : [button("Show it", () => show(clash))];
    return [element("p", { text }), ...(here ? [legend] : []), element("div", {}, ...buttons)];
  }

  /** Their side, drawn on the photo. @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const clash = this.#clash;
    if (!clash || clash.theirs.deleted || this.#card.dataset.image !== String(clash.image)) return false;
    const shape = shapeOfAnnotation(clash.theirs);
    context.beginPath();
    for (const ring of shape.cap.visible) traceRing(context, view, ring);
    const placed = placedWhole(shape.cap);
    if (placed) traceWhole(context, view, placed);
    context.setLineDash([6, 4]);
    strokeCased(context, { colour: COLOURS.theirs, width: 2.5, casing: CASING });
    context.setLineDash([]);
    return true;
  };
}

/** @type {(text: string, click: () => void) => HTMLElement} */
function button(text, click) {
  return element("button", { text, click, attributes: { type: "button" } });
}
