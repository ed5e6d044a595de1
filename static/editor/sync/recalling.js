/**
 * Asks the journal what it takes to take back what this page does not remember: what was done before it was
 * loaded, or by others. One question at a time, and only once everything of ours is stored.
 *
 * @module
 */

import { shapeOfAnnotation } from "../geometry/shapes.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Recall} Recall */
/** @typedef {import("../protocol.js").Reversal} Reversal */
/** @typedef {import("../state/history.js").ChangeSet} ChangeSet */
/** @typedef {Omit<Recall, "type">} Question */

export class Recalling {
  /** @type {Question[]} */
  #questions = [];
  #asked = false;
  /** How many answers are on their way to questions that were dropped. */
  #dropped = 0;

  /** The one that is asked, or is to be. @returns {Question | null} */
  get first() {
    return this.#questions[0] ?? null;
  }

  /** @type {(question: Question) => void} */
  ask(question) {
    this.#questions.push(question);
  }

  /**
   * Asks the first question, unless that is done already.
   *
   * @param {(message: Recall) => boolean} send
   * @returns {boolean} false where it cannot be sent
   */
  next(send) {
    if (this.first && !this.#asked) this.#asked = send({ type: "recall", ...this.first });
    return this.#asked || !this.first;
  }

  /** The first question needs no answer any more. */
  skip() {
    if (this.#asked) this.#dropped++;
    this.#asked = false;
    this.#questions.shift();
  }

  /** Something else was done: nothing that was asked counts any longer. */
  drop() {
    while (this.first) this.skip();
  }

  /** The line is broken, and no answer will come. @returns {boolean} whether one was waited for */
  lost() {
    const any = this.first !== null;
    this.#questions = [];
    this.#asked = false;
    this.#dropped = 0;
    return any;
  }

  /** The question that the answer now come is about. @returns {Question | null} */
  answered() {
    if (this.#dropped > 0) {
      this.#dropped--;
      return null;
    }
    this.#asked = false;
    return this.#questions.shift() ?? null;
  }
}

/**
 * A change set of the journal as this page's history holds them: from what the caps were to what they are.
 *
 * @param {Reversal} reversal
 * @returns {ChangeSet}
 */
export function changeSetOf({ id, returns, status, verdict }) {
  return {
    ids: [id],
    changes: returns.map(({ annotation, cap, deleted }) => {
      const after = shapeOfAnnotation(annotation);
      return { before: cap && { ...after, cap, deleted }, after };
    }),
    status: status && { before: status[1], after: status[0] },
    verdict,
  };
}
