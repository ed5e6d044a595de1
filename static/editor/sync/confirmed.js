/**
 * Annotations, and the status of images, as the server last told of them.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Annotation} Annotation */

export class Confirmed {
  /** @type {Map<string, Annotation>} */
  #annotations = new Map();
  /** By the number of the image. @type {Map<number, import("../protocol.js").Status>} */
  statuses = new Map();

  /** @type {(uid: string) => Annotation | null} */
  get(uid) {
    return this.#annotations.get(uid) ?? null;
  }

  /** @type {(annotation: Annotation) => void} */
  put(annotation) {
    this.#annotations.set(annotation.uid, annotation);
  }

  /**
   * Takes in an image as the store has it, without its deleted annotations.
   *
   * @param {number} image
   * @param {Annotation[]} annotations  all live ones of the image
   * @returns {Set<string>} what others changed or deleted since the server last told of it
   */
  refresh(image, annotations) {
    const now = new Map(annotations.map(({ uid, revision }) => [uid, revision]));
    const movedOn = [...this.#annotations.values()].filter((known) => {
      return known.image === image && now.get(known.uid) !== (known.deleted ? undefined : known.revision);
    });
    for (const { uid } of movedOn) this.#annotations.delete(uid);
    for (const annotation of annotations) this.put(annotation);
    return new Set(movedOn.map(({ uid }) => uid));
  }

  /** What is known to be deleted of an image. @type {(image: number) => Annotation[]} */
  deletedOf(image) {
    return [...this.#annotations.values()].filter((known) => known.image === image && known.deleted);
  }
}
