/**
 * Keeps the store and the server in step: local changes become edits in the outbox, one change set in
 * flight at a time; outcomes and other people's changes flow back into the store.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { shapeOfAnnotation } from "../geometry/shapes.js";
import { newId } from "../ids.js";
import { stepsOf } from "../state/changes.js";
import { History } from "../state/history.js";
import { Confirmed } from "./confirmed.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Edit} Edit */
/** @typedef {import("../protocol.js").Outcome} Outcome */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/store.js").Store} Store */
/** @typedef {import("./outbox.js").Outbox} Outbox */

/**
 * An edit that was made on another revision than the server has, and the other side of it.
 *
 * @typedef {{uid: string, image: number, theirs: Annotation, user: string}} OpenConflict
 */

/**
 * @typedef {Object} Wires
 * @property {Store} store
 * @property {(message: ToServer) => boolean} send
 * @property {() => void} stalled  the server has not answered for long
 * @property {() => void} progress  what waits has changed
 * @property {(text: string) => void} refused
 */

const PATIENCE_MS = 15000;

export class Sync {
  /** @type {Outbox | null} */
  #outbox = null;
  /** @type {Map<number, History>} */
  #histories = new Map();
  #confirmed = new Confirmed();
  /** The ids of the edits in flight. @type {Set<string>} */
  #flying = new Set();
  #timer = 0;
  #wires;
  image = 0;
  /** @type {OpenConflict[]} */
  conflicts = [];

  /** @param {Wires} wires */
  constructor(wires) {
    this.#wires = wires;
  }

  get history() {
    return this.#historyOf(this.image);
  }

  /** @type {(image: number) => History} */
  #historyOf(image) {
    let history = this.#histories.get(image);
    if (!history) this.#histories.set(image, (history = new History()));
    return history;
  }

  get waiting() {
    return this.#outbox?.waiting ?? 0;
  }

  get kept() {
    return this.#outbox?.kept ?? true;
  }

  /** @type {(outbox: Outbox) => void} */
  use(outbox) {
    this.#outbox = outbox;
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
  }

  /**
   * The server will never take what is in flight.
   *
   * @param {string} reason
   */
  giveUp(reason) {
    const edits = [...this.#flying].flatMap((id) => this.#outbox?.get(id) ?? []);
    this.#apply(edits.flatMap((edit) => this.#refuse(edit, reason)));
    this.pause();
  }

  /**
   * Makes changes, to be undone in one step.
   *
   * @param {Change[]} changes
   */
  commit(changes) {
    if (changes.length === 0) return;
    this.history.push(changes);
    this.#carryOut(changes);
  }

  undo() {
    return this.#carryOut(this.history.undo((uid) => this.#current(uid)));
  }

  redo() {
    return this.#carryOut(this.history.redo((uid) => this.#current(uid)));
  }

  /** @type {(uid: string) => Shape | null} */
  #current(uid) {
    const known = this.#confirmed.get(uid);
    return this.#wires.store.get(uid) ?? (known ? shapeOfAnnotation(known) : null);
  }

  /** @type {(changes: Change[] | null) => Change[] | null} */
  #carryOut(changes) {
    if (!changes) return null;
    const edits = changes.flatMap((change) => this.#editsOf(change));
    this.#wires.store.apply(changes);
    if (edits.length) this.#outbox?.add(edits);
    for (const { after } of changes) this.#foldIntoHeld(after);
    this.pump();
    return changes;
  }

  /** @type {(change: Change) => Edit[]} */
  #editsOf(change) {
    const { uid } = change.after;
    if (this.#outbox?.holds(uid)) return [];
    const last = this.#outbox?.lastOf(uid);
    const base = last ? last.base + 1 : (change.before?.revision ?? 0);
    return stepsOf(change).map((cap, i) => {
      return { id: newId(), annotation: uid, image: this.image, base: base + i, cap };
    });
  }

  /**
   * What a person goes on changing while a conflict waits belongs to their side of it.
   *
   * @type {(shape: Shape) => void}
   */
  #foldIntoHeld(shape) {
    const held = this.#outbox?.holds(shape.uid) ? this.#outbox.lastOf(shape.uid) : null;
    if (held) this.#outbox?.hold({ ...held, cap: shape.deleted ? null : shape.cap });
  }

  /** Sends the next change set, unless one is on its way. */
  pump() {
    this.#wires.progress();
    const edits = this.#flying.size ? [] : (this.#outbox?.head() ?? []);
    if (edits.length === 0 || !this.#wires.send({ type: "edits", edits })) return;
    this.#flying = new Set(edits.map(({ id }) => id));
    clearTimeout(this.#timer);
    this.#timer = setTimeout(() => this.#wires.stalled(), PATIENCE_MS);
  }

  /**
   * An image as the store has it, with what is still unacknowledged applied over it.
   *
   * @param {number} image
   * @param {Annotation[]} annotations
   */
  open(image, annotations) {
    this.image = image;
    this.history.forget(this.#confirmed.refresh(image, annotations));
    const all = [...this.#confirmed.deletedOf(image), ...annotations];
    const shapes = new Map(all.map((known) => [known.uid, shapeOfAnnotation(known)]));
    for (const edit of this.#outbox?.edits() ?? []) {
      if (edit.image === image) overlay(shapes, edit);
    }
    this.#wires.store.replace([...shapes.values()]);
  }

  /** What became of edits that were sent. @type {(outcomes: Outcome[]) => void} */
  receive(outcomes) {
    this.#apply(outcomes.flatMap((outcome) => this.#settle(outcome)));
    if (this.#flying.size === 0) clearTimeout(this.#timer);
    this.pump();
  }

  /** @type {(changes: Change[]) => void} */
  #apply(changes) {
    if (changes.length) this.#wires.store.apply(changes);
  }

  /** Ends an edit; returns what that changes in the store. @type {(outcome: Outcome) => Change[]} */
  #settle(outcome) {
    const edit = this.#outbox?.get(outcome.edit);
    this.#flying.delete(outcome.edit);
    if (!edit) return [];
    if (outcome.outcome === "refused") return this.#refuse(edit, outcome.reason);
    if (outcome.outcome === "conflict") return this.#ask(edit, outcome.theirs, outcome.user);
    this.#outbox?.acknowledged(edit.id);
    return this.#adopt(outcome.annotation);
  }

  /**
   * Takes the server's word for a cap, unless newer words of ours are still to be sent.
   *
   * @param {Annotation} annotation
   * @returns {Change[]} what that changes in the store
   */
  #adopt(annotation) {
    this.#confirmed.put(annotation);
    if (annotation.image !== this.image || this.#outbox?.lastOf(annotation.uid)) return [];
    const before = this.#wires.store.get(annotation.uid);
    const shape = shapeOfAnnotation(annotation);
    const cap = before && same(before.cap, shape.cap) ? before.cap : shape.cap;
    return [{ before, after: { ...shape, cap } }];
  }

  /** Leaves it to the person which side of a conflict is kept. @type {(edit: Edit, theirs: Annotation, user: string) => Change[]} */
  #ask(edit, theirs, user) {
    const last = this.#outbox?.lastOf(edit.annotation) ?? edit;
    this.#outbox?.hold({ ...edit, cap: last.cap });
    this.#confirmed.put(theirs);
    this.conflicts = this.conflicts.filter(({ uid }) => uid !== theirs.uid);
    this.conflicts.push({ uid: theirs.uid, image: edit.image, theirs, user });
    return [];
  }

  /** Goes back to what the server has. @type {(edit: Edit, reason: string) => Change[]} */
  #refuse(edit, reason) {
    this.#outbox?.drop(edit.annotation);
    this.#historyOf(edit.image).forget(new Set([edit.annotation]));
    this.#wires.refused(reason);
    const known = this.#confirmed.get(edit.annotation);
    if (known) return this.#adopt(known);
    const before = this.#wires.store.get(edit.annotation);
    return before ? [{ before, after: { ...before, deleted: true } }] : [];
  }

  /**
   * Ends a conflict: what this browser shows goes on top of theirs, or theirs takes its place.
   *
   * @param {OpenConflict} conflict
   * @param {"mine" | "theirs"} whose
   */
  resolve(conflict, whose) {
    const mine = this.#outbox?.lastOf(conflict.uid);
    this.conflicts = this.conflicts.filter((other) => other !== conflict);
    this.#outbox?.drop(conflict.uid);
    this.#historyOf(conflict.image).forget(new Set([conflict.uid]));
    if (whose === "mine" && mine) {
      this.#outbox?.add([{ ...mine, id: newId(), base: conflict.theirs.revision }]);
    } else {
      this.#apply(this.#adopt(conflict.theirs));
    }
    this.pump();
  }

  /**
   * Somebody else, or a job, changed caps.
   *
   * @param {number} image
   * @param {Annotation[]} annotations
   */
  changed(image, annotations) {
    const revision = (/** @type {string} */ uid) => this.#confirmed.get(uid)?.revision ?? 0;
    const newer = annotations.filter((annotation) => annotation.revision > revision(annotation.uid));
    this.#historyOf(image).forget(new Set(newer.map(({ uid }) => uid)));
    const current = annotations.filter((annotation) => annotation.revision >= revision(annotation.uid));
    this.#apply(current.flatMap((annotation) => this.#adopt(annotation)));
  }
}

/** @type {(shapes: Map<string, Shape>, edit: Edit) => void} */
function overlay(shapes, edit) {
  const before = shapes.get(edit.annotation);
  const cap = edit.cap ?? before?.cap;
  if (!cap) return;
  shapes.set(edit.annotation, {
    uid: edit.annotation,
    cap,
    revision: before?.revision ?? 0,
    deleted: edit.cap === null,
    whole: before?.whole ?? null,
    centre: before?.centre ?? null,
    score: null,
  });
}
