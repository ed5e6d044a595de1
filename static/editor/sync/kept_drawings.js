/**
 * Keeps half-drawn outlines in the browser's storage, image by image, until they are closed or dropped: so
 * another image, a reload or a crash loses nothing. A tab takes up what a closed tab has left, and leaves
 * alone what another tab is drawing.
 *
 * @module
 */

import { newId } from "../ids.js";
import { keysWith } from "./stored_edits.js";
import { lock } from "./tab_lock.js";

/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../state/half_drawn.js").HalfDrawn} HalfDrawn */
/** @typedef {{key: string, points: Point[]}} Kept */

const ROOT = "fairyring:drawing:";
/** A stroke places many points a second; so often they are written down. */
const WRITE_MS = 200;
/** How long a page that is being reloaded may still hold its locks. */
const LEFT_MS = 400;

export class KeptDrawings {
  /** What is kept under this tab's own keys, by image. @type {Map<number, Kept>} */
  #own = new Map();
  #project = "";
  #image = 0;
  #timer = 0;
  /** Whether the storage has no room for what was drawn last. */
  #lost = false;
  #halfDrawn;
  #storage;
  #lock;

  /**
   * @param {HalfDrawn} halfDrawn
   * @param {{storage: Storage | null, lock?: typeof lock}} browser
   */
  constructor(halfDrawn, { storage, lock: take = lock }) {
    this.#halfDrawn = halfDrawn;
    this.#storage = storage;
    this.#lock = take;
    halfDrawn.changed.listen(() => {
      this.#timer ||= setTimeout(() => this.write(), WRITE_MS);
    });
  }

  /** Whether what is half drawn would survive a reload. */
  get kept() {
    this.write();
    return !this.#lost;
  }

  /** @type {(project: string) => void} */
  use(project) {
    this.#project = project;
  }

  /** Another image comes. @returns {boolean} whether an outline stays behind, half drawn */
  leave() {
    this.write();
    const stays = !this.#halfDrawn.empty;
    this.#image = 0;
    this.#halfDrawn.begin([]);
    clearTimeout(this.#timer);
    this.#timer = 0;
    return stays;
  }

  /**
   * Brings back what is half drawn on an image.
   *
   * @type {(image: number) => Promise<boolean>} whether that is anything
   */
  async open(image) {
    this.#image = image;
    const kept = this.#own.get(image) ?? (await this.#takeUp(image));
    if (!kept || this.#image !== image || !this.#halfDrawn.empty) return false;
    this.#own.set(image, kept);
    this.#halfDrawn.begin(kept.points);
    return true;
  }

  /** What no other tab holds. @type {(image: number) => Promise<Kept | null>} */
  async #takeUp(image) {
    for (const key of keysWith(this.#storage, this.#prefix(image))) {
      const points = pointsIn(this.#storage?.getItem(key) ?? "");
      if (points.length === 0) this.#storage?.removeItem(key);
      else if (await this.#lock(key, { wait_ms: LEFT_MS })) return { key, points };
    }
    return null;
  }

  /** @type {(image: number) => string} */
  #prefix(image) {
    return `${ROOT}${this.#project}:${image}:`;
  }

  /** Writes down what is half drawn now. */
  write() {
    clearTimeout(this.#timer);
    this.#timer = 0;
    if (!this.#image) return;
    const points = [...this.#halfDrawn.points];
    const key = this.#own.get(this.#image)?.key;
    if (points.length) this.#put(key ?? this.#newKey(), points);
    else if (key) {
      this.#storage?.removeItem(key);
      this.#own.delete(this.#image);
    }
  }

  #newKey() {
    const key = `${this.#prefix(this.#image)}${newId()}`;
    void this.#lock(key);
    return key;
  }

  /** @type {(key: string, points: Point[]) => void} */
  #put(key, points) {
    this.#own.set(this.#image, { key, points });
    try {
      if (!this.#storage) throw new Error("no storage");
      this.#storage.setItem(key, JSON.stringify(points));
      this.#lost = false;
    } catch {
      this.#lost = true;
    }
  }
}

/** The points that were written down; none where that cannot be read. @type {(text: string) => Point[]} */
function pointsIn(text) {
  try {
    const points = JSON.parse(text);
    return Array.isArray(points) && points.every(isPoint) ? points : [];
  } catch {
    return [];
  }
}

/** @type {(value: unknown) => value is Point} */
function isPoint(value) {
  return Array.isArray(value) && value.length === 2 && value.every(Number.isFinite);
}
