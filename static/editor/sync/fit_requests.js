/**
 * Asks the server for the whole outline of a cap: one question at a time, and of those that wait only the
 * latest.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Fitted} Fitted */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {{image: number, annotation: string, cap: Cap}} Question */

const PATIENCE_MS = 2000;

export class FitRequests {
  /** @type {Question | null} */
  #next = null;
  /** @type {Question | null} */
  #asked = null;
  #askedAt = 0;
  #seq = 0;
  #send;

  /** @param {(message: ToServer) => boolean} send */
  constructor(send) {
    this.#send = send;
  }

  /** @type {(question: Question) => void} */
  ask(question) {
    this.#next = question;
    if (!this.#asked || performance.now() - this.#askedAt > PATIENCE_MS) this.#go();
  }

  /** What was asked is not waited for any longer: another image is shown, or the line was broken. */
  forget() {
    this.#next = this.#asked = null;
  }

  #go() {
    const question = this.#next;
    this.#next = this.#asked = null;
    if (!question || !this.#send({ type: "refit", seq: ++this.#seq, ...question })) return;
    this.#asked = question;
    this.#askedAt = performance.now();
  }

  /**
   * The question this fit answers; null for an answer that is no longer waited for.
   *
   * @param {Fitted} fitted
   * @returns {Question | null}
   */
  take(fitted) {
    if (fitted.seq !== this.#seq) return null;
    const question = this.#asked;
    this.#go();
    return question;
  }
}
