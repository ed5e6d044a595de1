/**
 * The caps that are selected, the one under the pointer, and the handle that the arrow keys move.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { signal } from "./signal.js";

/** @typedef {import("../geometry/handles.js").Handle} Handle */

export class Selection {
  /** @type {ReadonlySet<string>} */
  #uids = new Set();
  /** @type {string | null} */
  #hovered = null;
  /** @type {Handle | null} */
  #handle = null;
  /** Other caps are selected: those that were and those that are. @type {import("./signal.js").Signal<[string[], string[]]>} */
  changed = signal();
  /** Another cap is hovered, or another handle is active. @type {import("./signal.js").Signal<[]>} */
  pointed = signal();

  get uids() {
    return this.#uids;
  }

  /** The cap that was pointed at since the selection was made, unless it is selected. */
  get hovered() {
    return this.#hovered;
  }

  /** The active handle of the one selected cap. */
  get handle() {
    return this.#handle;
  }

  /** The one selected cap's. @returns {string | null} */
  get soleUid() {
    return this.#uids.size === 1 ? [...this.#uids][0] : null;
  }

  /** @type {(uid: string) => boolean} */
  has(uid) {
    return this.#uids.has(uid);
  }

  /** Selects these and no others. @type {(uids: string[]) => boolean} whether others were selected before */
  set(uids) {
    const before = [...this.#uids];
    this.#uids = new Set(uids);
    this.#handle = null;
    this.hover(null);
    const changed = !same(before, uids);
    if (changed) this.changed.emit(before, uids);
    return changed;
  }

  /** Deselects what is there no longer. @type {(isThere: (uid: string) => boolean) => void} */
  keep(isThere) {
    const left = [...this.#uids].filter(isThere);
    if (left.length < this.#uids.size) this.set(left);
  }

  /** Exchanges selected caps for what became of them; the active handle stays. @type {(heirs: Map<string, string>) => void} */
  follow(heirs) {
    const handle = this.#handle;
    this.set([...this.#uids].map((uid) => heirs.get(uid) ?? uid));
    this.#handle = handle;
  }

  /** @type {(uid: string | null) => void} */
  hover(uid) {
    if (uid === this.#hovered) return;
    this.#hovered = uid;
    this.pointed.emit();
  }

  /** @type {(handle: Handle | null) => void} */
  activate(handle) {
    if (same(handle, this.#handle)) return;
    this.#handle = handle;
    this.pointed.emit();
  }
}
