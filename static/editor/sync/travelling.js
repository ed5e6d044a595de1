/**
 * Goes back through what was done, and forth again: by this page's history, and by the journal beyond that.
 *
 * @module
 */

import { newId } from "../ids.js";
import { backwards } from "../state/history.js";
import { Recalling, changeSetOf } from "./recalling.js";

/** @typedef {import("../protocol.js").Recalled} Recalled */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/history.js").Move} Move */
/** @typedef {import("./local.js").Local} Local */
/** @typedef {"undo" | "redo"} Way */

/** What was taken back or done again, and how many caps were not, as others have changed them since. @typedef {{image: number, way: Way, changes: Change[], stayed: number, verdict: import("../protocol.js").VerdictToWithdraw | null}} Travelled */

/**
 * @typedef {Object} Wires
 * @property {(message: ToServer) => boolean} send
 * @property {(travelled: Travelled) => void} travelled
 * @property {(why: "nothing" | "offline", way: Way) => void} stuck  nothing can be undone, or done again
 */

export class Travelling {
  #recalling = new Recalling();
  /** The image whose status was the last thing changed here, and which came after it. @type {{image: number, next: number | null} | null} */
  #finished = null;
  #local;
  #wires;
  #carryOut;
  #pump;

  /**
   * @param {Local} local
   * @param {Wires} wires
   * @param {Object} how
   * @param {(image: number, changeSet: string, move: Move) => void} how.carryOut
   * @param {() => boolean} how.pump  sends what is next; false where it cannot
   */
  constructor(local, wires, { carryOut, pump }) {
    this.#local = local;
    this.#wires = wires;
    this.#carryOut = carryOut;
    this.#pump = pump;
  }

  /** Something new was done: to the status of this image, or else. @type {(finished: number | null) => void} */
  done(finished) {
    this.#finished = finished === null ? null : { image: finished, next: null };
    this.#recalling.drop();
  }

  /** The line is broken, and no answer of the journal will come. */
  lost() {
    if (this.#recalling.lost()) this.#wires.stuck("offline", "undo");
  }

  /** Undo leads back to an image that was just finished only from the one that came after it. @type {(image: number) => void} */
  opened(image) {
    const finished = this.#finished;
    if (!finished || (finished.next === null && image === finished.image)) return;
    if (finished.next === null) finished.next = image;
    else if (image !== finished.next) this.#finished = null;
  }

  /** Takes back what was done last here; what this page does not remember the journal does. */
  undo() {
    this.undoOn(this.#finished?.image ?? this.#local.image);
  }

  /** @type {(image: number) => void} */
  undoOn(image) {
    this.#finished = null;
    this.#travel("undo", image);
  }

  redo() {
    this.#finished = null;
    this.#travel("redo", this.#local.image);
  }

  /** @type {(way: Way, image: number) => void} */
  #travel(way, image) {
    const local = this.#local;
    const id = newId();
    const move = local.historyOf(image)[way](id, (uid) => local.current(uid));
    if (!move) return this.#ask({ image, way, change_set: null });
    const overtaken = move.status && move.status.before !== local.statusOf(image);
    const possible = overtaken ? { ...move, status: null } : move;
    if (possible.changes.length === 0 && !possible.status && !possible.verdict) return this.#travel(way, image);
    this.#carryOut(image, id, possible);
    this.#wires.travelled({ image, way, changes: possible.changes, stayed: 0, verdict: possible.verdict ?? null });
  }

  /** Takes back a change set of the image's history, whoever made it. @type {(image: number, changeSet: number) => void} */
  takeBack(image, changeSet) {
    this.#finished = null;
    this.#ask({ image, way: "undo", change_set: changeSet });
  }

  /** @type {(question: import("./recalling.js").Question) => void} */
  #ask(question) {
    this.#recalling.ask(question);
    if (!this.#pump()) {
      this.#recalling.lost();
      this.#wires.stuck("offline", question.way);
    }
  }

  /** The journal has answered. @type {(recalled: Recalled) => void} */
  recalled(recalled) {
    const question = this.#recalling.answered();
    if (question?.image === this.#local.image) {
      if (recalled.reversal) this.#takeBack(recalled.reversal, question.way, question.change_set !== null);
      else this.#wires.stuck("nothing", question.way);
    }
    this.#pump();
  }

  /** Asks the journal, unless this page has come to remember what is asked. @returns {boolean} false where it cannot */
  askJournal() {
    const question = this.#recalling.first;
    if (question?.change_set === null && this.#local.historyOf(question.image).depth[question.way]) {
      this.#recalling.skip();
      this.#travel(question.way, question.image);
      return true;
    }
    return this.#recalling.next(this.#wires.send);
  }

  /** @type {(reversal: import("../protocol.js").Reversal, way: Way, anew: boolean) => void} */
  #takeBack(reversal, way, anew) {
    const local = this.#local;
    for (const { annotation } of reversal.returns) local.confirmed.put(annotation);
    const set = changeSetOf(reversal);
    const move = backwards(set, (uid) => local.current(uid));
    const id = newId();
    const history = local.historyOf(this.#local.image);
    if (anew) history.push({ ids: [id], changes: move.changes, status: move.status });
    else if (way === "undo") history.wasUndone({ ...set, ids: [...set.ids, id] });
    else history.wasRedone({ ids: [...set.ids, id], changes: move.changes, status: move.status, verdict: null });
    if (move.changes.length || move.status || move.verdict)
      // What is taken back of caps is done anew, a status is as if nobody had said it.
      this.#carryOut(this.#local.image, id, anew && !move.status ? { ...move, takesBack: "" } : move);
    const { changes } = move;
    this.#wires.travelled({ image: this.#local.image, way, changes, stayed: reversal.changed_since, verdict: move.verdict ?? null });
  }
}
