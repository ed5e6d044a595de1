/**
 * Who waits for the server's answer to what was said of an image, to go on to the next one only if it was stored.
 *
 * @module
 */

export class Answers {
  /** By change set. @type {Map<string, {image: number, resolve: (stored: boolean) => void}>} */
  #waiting = new Map();

  /** Whether an answer about this image is still to come. @type {(image: number) => boolean} */
  areAwaitedOf(image) {
    return [...this.#waiting.values()].some((each) => each.image === image);
  }

  /** @type {(changeSet: string, image: number) => Promise<boolean>} whether it was not refused */
  to(changeSet, image) {
    return new Promise((resolve) => this.#waiting.set(changeSet, { image, resolve }));
  }

  /** @type {(changeSet: string, stored: boolean) => void} */
  come(changeSet, stored) {
    this.#waiting.get(changeSet)?.resolve(stored);
    this.#waiting.delete(changeSet);
  }

  /** The server is out of reach: what was said is kept and sent later, and nobody is held up meanwhile. */
  goOnWithout() {
    for (const { resolve } of this.#waiting.values()) resolve(true);
    this.#waiting.clear();
  }
}
