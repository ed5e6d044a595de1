/**
 * Keeps the store and the server in step: local changes become edits in the outbox, one piece of a change set
 * in flight at a time; outcomes and other people's changes flow back into the store.
 *
 * @module
 */

import { newId } from "../ids.js";
import { Answers } from "./answers.js";
import { statusAfter } from "./edits.js";
import { Local } from "./local.js";
import { isOfCap, isOfStatus, isVerdict } from "./outbox.js";
import { decide, refuse, settle, takeNews } from "./settle.js";
import { Travelling } from "./travelling.js";

/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Outcome} Outcome */
/** @typedef {import("../protocol.js").Recalled} Recalled */
/** @typedef {import("../protocol.js").Status} Status */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/history.js").Move} Move */
/** @typedef {import("../state/store.js").Store} Store */
/** @typedef {import("./local.js").OpenConflict} OpenConflict */
/** @typedef {import("./outbox.js").Edit} Edit */
/** @typedef {import("./outbox.js").Outbox} Outbox */
/** @typedef {"undo" | "redo"} Way */
/** @typedef {import("./travelling.js").Travelled} Travelled */

/**
 * @typedef {Object} Wires
 * @property {Store} store
 * @property {(message: ToServer) => boolean} send
 * @property {() => void} stalled  the server has not answered for long
 * @property {() => void} progress  what waits has changed
 * @property {(edit: Edit, reason: string) => void} refused
 * @property {(travelled: Travelled) => void} travelled
 * @property {(why: "nothing" | "offline", way: Way) => void} stuck  nothing can be undone, or done again
 */

const PATIENCE_MS = 15000;

export class Sync {
  #local;
  /** The edits in flight, by id, as they were sent. @type {Map<string, Edit>} */
  #flying = new Map();
  #timer = 0;
  #answers = new Answers();
  #wires;
  #travelling;

  /** @param {Wires} wires */
  constructor(wires) {
    this.#wires = wires;
    this.#local = new Local(wires.store);
    this.#travelling = new Travelling(this.#local, wires, {
      carryOut: (image, changeSet, move) => this.#carryOut(image, changeSet, move),
      pump: () => this.pump(),
    });
  }

  get image() {
    return this.#local.image;
  }

  get conflicts() {
    return this.#local.conflicts;
  }

  get waiting() {
    return this.#local.outbox.waiting;
  }

  get kept() {
    return this.#local.outbox.kept;
  }

  /** What people say of the image on screen. */
  get status() {
    return this.#local.statusOf(this.image);
  }

  /** @type {(outbox: Outbox) => void} */
  use(outbox) {
    this.#local.outbox = outbox;
  }

  /** The outbox holds edits now that another tab had left. */
  adopted() {
    this.#apply(this.#local.unshown());
    this.pump();
  }

  /** The connection is up (again): whatever was in flight may be lost, so send it once more. */
  resume() {
    this.#flying.clear();
    this.pump();
  }

  /** The connection is gone. */
  pause() {
    clearTimeout(this.#timer);
    this.#flying.clear();
    this.#answers.goOnWithout();
    this.#travelling.lost();
  }

  /** The server is there: it has said something. */
  heard() {
    if (this.#flying.size === 0) return;
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#wires.stalled(), PATIENCE_MS);
  }

  /**
   * The server will never take what is in flight.
   *
   * @param {string} reason
   */
  giveUp(reason) {
    const edits = [...this.#flying.keys()].flatMap((id) => this.#local.outbox.get(id) ?? []);
    for (const edit of edits) this.#refuse(edit, reason);
    this.pause();
  }

  /**
   * Makes changes, to be undone in one step.
   *
   * @param {Change[]} changes
   */
  commit(changes) {
    if (changes.length === 0) return;
    const id = newId();
    this.#travelling.done(null);
    this.#local.historyOf(this.image).push({ ids: [id], changes, status: null });
    this.#carryOut(this.image, id, { takesBack: "", changes, status: null });
  }

  /** Says something of the image on screen, to be undone in one step; whether it was not refused. @type {(after: Status) => Promise<boolean>} */
  async say(after) {
    const [id, before] = [newId(), this.status];
    // The key pressed twice: whoever pressed it first goes on.
    if (before === after) return !this.#answers.areAwaitedOf(this.image);
    const status = { before, after };
    this.#travelling.done(this.image);
    this.#local.historyOf(this.image).push({ ids: [id], changes: [], status });
    const answer = this.#answers.to(id, this.image);
    this.#carryOut(this.image, id, { takesBack: "", changes: [], status });
    return answer;
  }

  /**
   * Says something of the image on screen or of a cap of it, which can be undone but for a comment.
   *
   * @param {string | null} annotation
   * @param {import("../protocol.js").Says} says
   * @param {string} words
   * @returns {Promise<boolean>} whether it was not refused
   */
  async judge(annotation, says, words) {
    const [changeSet, before, said] = [newId(), this.status, { annotation, says, words }];
    /** @type {import("../protocol.js").Verdict} */
    const verdict = { ...said, id: newId(), image: this.image, change_set: changeSet };
    const after = statusAfter(before, [verdict]);
    if (says !== "comment") {
      this.#travelling.done(annotation === null ? this.image : null);
      const status = before === after ? null : { before, after };
      this.#local.historyOf(this.image).push({ ids: [changeSet], changes: [], status, verdict: said });
    }
    const answer = this.#answers.to(changeSet, this.image);
    this.#local.outbox.add([verdict]);
    this.#send();
    return answer;
  }

  /** Takes back what was done last here; what this page does not remember the journal does. */
  undo() {
    this.#travelling.undo();
  }

  redo() {
    this.#travelling.redo();
  }

  /** Whether the status of an image is what was changed there last. @type {(image: number) => boolean} */
  hasFinished(image) {
    return this.#local.historyOf(image).endsInStatus;
  }

  /** Takes back what was done last on an image. @type {(image: number) => void} */
  undoOn(image) {
    this.#travelling.undoOn(image);
  }

  /** Takes back a change set of the image's history, whoever made it. @type {(image: number, changeSet: number) => void} */
  takeBack(image, changeSet) {
    this.#travelling.takeBack(image, changeSet);
  }

  /** The journal has answered. @type {(recalled: Recalled) => void} */
  recalled(recalled) {
    this.#travelling.recalled(recalled);
  }

  /** @type {(image: number, changeSet: string, move: Move) => void} */
  #carryOut(image, changeSet, move) {
    this.#local.carryOut(image, changeSet, move);
    this.#send();
  }

  #send() {
    if (!this.pump()) this.#answers.goOnWithout();
  }

  /** Sends what is next, unless something is on its way. @returns {boolean} whether anything is, or could be */
  pump() {
    const { outbox } = this.#local;
    const { progress, send } = this.#wires;
    progress();
    if (this.#flying.size) return true;
    const edits = outbox.head();
    if (edits.length === 0) return this.#travelling.askJournal();
    const [statuses, verdicts] = [edits.filter(isOfStatus), edits.filter(isVerdict)];
    if (!send({ type: "edits", edits: edits.filter(isOfCap), statuses, verdicts })) return false;
    this.#flying = new Map(edits.map((edit) => [edit.id, edit]));
    this.heard();
    return true;
  }

  /**
   * An image as the store has it, with what is still unacknowledged applied over it.
   *
   * @param {import("../protocol.js").Image} image
   * @param {Annotation[]} annotations
   * @param {string[]} unchecked
   */
  open(image, annotations, unchecked) {
    this.#local.open(image, annotations, unchecked);
    this.#travelling.opened(image.id);
  }

  /** What became of edits that were sent. @type {(outcomes: Outcome[]) => void} */
  receive(outcomes) {
    this.#apply(outcomes.flatMap((outcome) => this.#settle(outcome)));
    if (this.#flying.size === 0) clearTimeout(this.#timer);
    this.pump();
  }

  /** @type {(changes: Change[]) => void} */
  #apply(changes) {
    if (changes.length) this.#local.store.apply(changes);
  }

  /** Ends an edit; returns what that changes in the store. @type {(outcome: Outcome) => Change[]} */
  #settle(outcome) {
    const edit = this.#local.outbox.get(outcome.edit);
    const sent = this.#flying.get(outcome.edit);
    this.#flying.delete(outcome.edit);
    // One that was rewritten meanwhile goes out once more, and this answer is not about it.
    if (!edit || (sent && sent !== edit && outcome.outcome !== "accepted")) return [];
    if (outcome.outcome === "refused") this.#wires.refused(edit, outcome.reason);
    if (!isOfCap(edit)) this.#answers.come(edit.change_set, outcome.outcome !== "refused");
    return settle(this.#local, edit, outcome);
  }

  /** @type {(edit: Edit, reason: string) => void} */
  #refuse(edit, reason) {
    this.#wires.refused(edit, reason);
    if (!isOfCap(edit)) this.#answers.come(edit.change_set, false);
    this.#apply(refuse(this.#local, edit));
  }

  /**
   * Ends a conflict: what this browser shows goes on top of theirs, or theirs takes its place.
   *
   * @param {OpenConflict} conflict
   * @param {"mine" | "theirs"} whose
   */
  resolve(conflict, whose) {
    this.#apply(decide(this.#local, conflict, whose));
    this.pump();
  }

  /**
   * Somebody else, or a job, changed caps.
   *
   * @param {number} image
   * @param {Annotation[]} annotations
   */
  changed(image, annotations) {
    this.#apply(takeNews(this.#local, image, annotations));
  }

  /** The status of an image is another now. @type {(image: number, status: Status, own: boolean) => void} */
  statusChanged(image, status, own) {
    if (!own) this.#local.historyOf(image).forgetStatus();
    this.#local.confirmed.statuses.set(image, status);
    this.#wires.progress();
  }
}
