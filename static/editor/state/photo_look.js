/**
 * How the photo looks and by what the caps are coloured. Nothing of it is stored with the image.
 *
 * @module
 */

import { signal } from "./signal.js";

/**
 * @typedef {Object} Look
 * @property {number} brightness  1: as it is
 * @property {number} contrast
 * @property {number} gamma
 * @property {"all" | "red" | "green" | "blue"} channel
 * @property {boolean} local  contrast evened out from place to place
 * @property {boolean} loupe
 * @property {"none" | "score" | "quality" | "sure"} colouring
 */

/** @type {Readonly<Look>} */
export const PLAIN = {
  brightness: 1,
  contrast: 1,
  gamma: 1,
  channel: "all",
  local: false,
  loupe: false,
  colouring: "none",
};

export class PhotoLook {
  /** @type {Readonly<Look>} */
  #look = PLAIN;
  /** What it was and what it is. @type {import("./signal.js").Signal<[Readonly<Look>, Readonly<Look>]>} */
  changed = signal();

  get now() {
    return this.#look;
  }

  /** Changes some of it; what is not known is passed over. @type {(changes: Partial<Look>) => void} */
  set(changes) {
    const before = this.#look;
    const known = Object.entries(changes).filter(([name, value]) => isOfKind(name, value));
    this.#look = { ...before, ...Object.fromEntries(known) };
    this.changed.emit(before, this.#look);
  }

  /** The photo as it is; the caps stay coloured as they are. */
  reset() {
    const { loupe, colouring } = this.#look;
    this.set({ ...PLAIN, loupe, colouring });
  }
}

/** @type {(name: string, value: unknown) => boolean} */
function isOfKind(name, value) {
  return Object.hasOwn(PLAIN, name) && typeof value === typeof Reflect.get(PLAIN, name);
}
