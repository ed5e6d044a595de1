/**
 * The conflict dialog: shows both versions of a cap that two people changed, and lets the person choose.
 *
 * @module
 */

import { CASING, COLOURS } from "../render/palette.js";
import { strokeCased, traceCap } from "../render/paths.js";
import { element } from "./dom.js";

/** @typedef {import("../sync/sync.js").OpenConflict} OpenConflict */

/**
 * @typedef {Object} Callbacks
 * @property {(conflict: OpenConflict, whose: "mine" | "theirs") => void} resolve
 * @property {(conflict: OpenConflict) => void} show  brings the cap into view
 */

export class ConflictDialog {
  /** The one it is about. @type {OpenConflict | null} */
  #conflict = null;
  #dialog = element("div", {
    class: "fairyring-conflict",
    attributes: { role: "alertdialog", "aria-label": "Conflict" },
  });
  #callbacks;

  /**
   * @param {HTMLElement} host
   * @param {Callbacks} callbacks
   */
  constructor(host, callbacks) {
    this.#callbacks = callbacks;
    this.#dialog.dataset.fairyringChrome = "";
    this.#dialog.hidden = true;
    host.append(this.#dialog);
  }

  /**
   * @param {OpenConflict[]} conflicts
   * @param {number} image the one on screen
   */
  update(conflicts, image) {
    const conflict = conflicts.find((other) => other.image === image) ?? conflicts[0] ?? null;
    if (conflict === this.#conflict && this.#dialog.dataset.image === String(image)) return;
    const fresh = conflict !== this.#conflict;
    this.#conflict = conflict;
    this.#dialog.hidden = conflict === null;
    this.#dialog.dataset.image = String(image);
    if (!conflict) return;
    this.#dialog.replaceChildren(...this.#content(conflict, conflicts.length, conflict.image === image));
    if (fresh && conflict.image === image) this.#callbacks.show(conflict);
  }

  /** @type {(conflict: OpenConflict, count: number, here: boolean) => Node[]} */
  #content(conflict, count, here) {
    const { theirs, user } = conflict;
    const did = theirs.deleted ? "deleted" : "changed";
    const more = count > 1 ? ` (1 of ${count})` : "";
    const where = here ? "this cap" : "a cap on another image";
    const text = `${user} ${did} ${where} while you were changing it.${more}`;
    const legend = element(
      "p",
      { class: "fairyring-conflict-legend" },
      element("span", { class: "is-mine", text: "yours" }),
      element("span", { class: "is-theirs", text: theirs.deleted ? `${user}: deleted` : user }),
    );
    const { resolve, show } = this.#callbacks;
    const buttons = here
      ? [
          button("Keep mine", () => resolve(conflict, "mine")),
          button("Take theirs", () => resolve(conflict, "theirs")),
        ]
      : [button("Show it", () => show(conflict))];
    return [element("p", { text }), ...(here ? [legend] : []), element("div", {}, ...buttons)];
  }

  /** Their side, drawn on the photo. @type {import("../render/overlay.js").Sketch} */
  sketch = (context, view) => {
    const conflict = this.#conflict;
    const here = this.#dialog.dataset.image === String(conflict?.image);
    if (!conflict || conflict.theirs.deleted || !here) return false;
    const { cap } = conflict.theirs;
    context.beginPath();
    traceCap(context, view, cap);
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
