/**
 * Asks the server what the network sees: one question at a time. Of questions that may be dropped only the latest
 * waits; the others are answered in their order.
 *
 * @module
 */

/** @typedef {import("../protocol.js").FoundCap} FoundCap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {{points: Point[], wanted: boolean[], box: [number, number, number, number] | null, besides?: string | null}} Question */
/** @typedef {{question: Question, answer: (found: FoundCap | null) => void}} Waiting */

/** Who draws an outline to a rim waits no longer for the network than this. */
const PATIENCE_MS = 600;
/** Asks for no cap: the network looks at the photo, so that it answers at once later. @type {Question} */
export const LOOK = { points: [], wanted: [], box: null };

export class CapRequests {
  /** @type {Waiting[]} */
  #kept = [];
  /** @type {Waiting | null} */
  #latest = null;
  /** @type {Waiting | null} */
  #asked = null;
  #seq = 0;
  /** The image that was asked about last and answered. @type {number | null} */
  #seen = null;
  #send;
  #image;

  /**
   * @param {(message: ToServer) => boolean} send
   * @param {() => number | null} image  the one on screen
   */
  constructor(send, image) {
    this.#send = send;
    this.#image = image;
  }

  /** Whether an answer is waited for. */
  get busy() {
    return this.#asked !== null;
  }

  /** Whether the network has seen the photo on screen, and so answers at once. */
  get sees() {
    return this.#seen !== null && this.#seen === this.#image();
  }

  /**
   * What the network sees; null where the question was dropped, or the server cannot be reached.
   *
   * @param {Question} question
   * @param {{keep: boolean}} how  whether it must be answered, whatever is asked later
   * @returns {Promise<FoundCap | null>}
   */
  ask(question, { keep }) {
    return new Promise((answer) => {
      if (keep) this.#kept.push({ question, answer });
      else {
        this.#latest?.answer(null);
        this.#latest = { question, answer };
      }
      this.#go();
    });
  }

  /**
   * The rim of the cap in a box, of its largest part; null where the network sees none, has not seen the photo, or
   * takes long.
   *
   * @param {[number, number, number, number]} box
   * @param {string} besides  an annotation that hides nothing of it
   * @returns {Promise<number[] | null>}
   */
  async rimIn(box, besides) {
    if (!this.sees) return null;
    const answer = this.ask({ points: [], wanted: [], box, besides }, { keep: true });
    const late = new Promise((resolve) => setTimeout(() => resolve(null), PATIENCE_MS));
    const found = /** @type {FoundCap | null} */ (await Promise.race([answer, late]));
    return found?.visible?.toSorted((a, b) => b.length - a.length)[0] ?? null;
  }

  /** Nothing that was asked is waited for: another image is shown, or the line was broken. */
  forget() {
    const all = [this.#asked, this.#latest, ...this.#kept];
    this.#seen = null;
    this.#asked = this.#latest = null;
    this.#kept = [];
    for (const waiting of all) waiting?.answer(null);
  }

  #go() {
    if (this.#asked) return;
    const next = this.#kept.shift() ?? this.#latest;
    if (!next) return;
    if (next === this.#latest) this.#latest = null;
    const image = this.#image();
    const { besides = null, ...question } = next.question;
    if (image !== null && this.#send({ type: "find_cap", seq: ++this.#seq, image, besides, ...question }))
      this.#asked = next;
    else next.answer(null);
  }

  /** @type {(found: FoundCap) => void} */
  take(found) {
    if (found.seq !== this.#seq || !this.#asked) return;
    const { answer } = this.#asked;
    this.#asked = null;
    this.#seen = found.image;
    answer(found);
    this.#go();
  }
}
