/**
 * Asks the server what the network sees: one question at a time. Of questions that may be dropped only the latest
 * waits; the others are answered in their order.
 *
 * @module
 */

/** @typedef {import("../protocol.js").FoundCap} FoundCap */
/** @typedef {import("../protocol.js").Point} Point */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {{points: Point[], wanted: boolean[], box: [number, number, number, number] | null}} Question */
/** @typedef {{question: Question, answer: (found: FoundCap | null) => void}} Waiting */

export class CapRequests {
  /** @type {Waiting[]} */
  #kept = [];
  /** @type {Waiting | null} */
  #latest = null;
  /** @type {Waiting | null} */
  #asked = null;
  #seq = 0;
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

  /** Nothing that was asked is waited for: another image is shown, or the line was broken. */
  forget() {
    const all = [this.#asked, this.#latest, ...this.#kept];
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
    if (image !== null && this.#send({ type: "find_cap", seq: ++this.#seq, image, ...next.question }))
      this.#asked = next;
    else next.answer(null);
  }

  /** @type {(found: FoundCap) => void} */
  take(found) {
    if (found.seq !== this.#seq || !this.#asked) return;
    const { answer } = this.#asked;
    this.#asked = null;
    answer(found);
    this.#go();
  }
}
