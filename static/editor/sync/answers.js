/**
 * Who waits for the server's answer to what was said of an image, to go on to the next one only if it was stored.
 *
 * @module
 */

export class Answers {
  /** By change set. @type {Map<string, (stored: boolean) => void>} */
  #waiting = new Map();

  get awaited() {
    return this.#waiting.size > 0;
  }

  /** @type {(changeSet: string) => Promise<boolean>} whether it was not refused */
  to(changeSet) {
    return new Promise((resolve) => this.#waiting.set(changeSet, resolve));
  }

  /** @type {(changeSet: string, stored: boolean) => void} */
  come(changeSet, stored) {
    this.#waiting.get(changeSet)?.(stored);
    this.#waiting.delete(changeSet);
  }

  /** The server is out of reach: what was said is kept and sent later, and nobody is held up meanwhile. */
  goOnWithout() {
    for (const resolve of this.#waiting.values()) resolve(true);
    this.#waiting.clear();
  }
}
