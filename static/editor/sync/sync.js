/**
 * Keeps the store and the server in step: local changes become edits in the outbox, one change set in
 * flight at a time; outcomes and other people's changes flow back into the store.
 *
 * @module
 */

import { History } from "../state/history.js";
import { sameCap, shapeOfAnnotation, stepsOf } from "../state/store.js";
import { newId } from "./outbox_owner.js";

/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Edit} Edit */
/** @typedef {import("../protocol.js").FromServer} FromServer */
/** @typedef {import("../protocol.js").Outcome} Outcome */
/** @typedef {import("../protocol.js").ToServer} ToServer */
/** @typedef {import("./outbox.js").Outbox} Outbox */
/** @typedef {import("../state/store.js").Change} Change */
/** @typedef {import("../state/store.js").Shape} Shape */
/** @typedef {import("../state/store.js").Store} Store */
/** @typedef {{uid: string, image: number, theirs: Annotation, user: string}} Clash */

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
  /** @type {Map<string, Annotation>} */
  #confirmed = new Map();
  /** @type {string[]} */
  #flying = [];
  #timer = 0;
  #wires;
  image = 0;
  /** @type {Clash[]} */
  clashes = [];

  /** @param {Wires} wires */
  constructor(wires) {
    this.#wires = wires;
  }

  get history() {
    let history = this.#histories.get(this.image);
    if (!history) this.#histories.set(this.image, (history = new History()));
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
    this.#flying = [];
    this.pump();
  }

  /**
   * The server will never take what is in flight.
   *
   * @param {string} reason
   */
  giveUp(reason) {
    const hopeless = new Set(this.#flying);
    for (const edit of this.#outbox?.edits() ?? []) if (hopeless.has(edit.id)) this.#refuse(edit, reason);
    this.pause();
  }

  /** The connection is gone. */
  pause() {
    clearTimeout(this.#timer);
    this.#flying = [];
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
    this.#wires.store.apply(changes, "local");
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
    const batch = this.#flying.length ? null : this.#outbox?.head();
    if (!batch || !this.#wires.send({ type: "edits", edits: batch.edits })) return;
    this.#flying = batch.edits.map((edit) => edit.id);
    clearTimeout(this.#timer);
    this.#timer = window.setTimeout(() => this.#wires.stalled(), PATIENCE_MS);
  }

  /**
   * An image as the store has it, with what is still unacknowledged applied over it.
   *
   * @param {number} image
   * @param {Annotation[]} annotations
   */
  open(image, annotations) {
    this.image = image;
    this.history.forget(this.#movedOn(image, annotations));
    for (const annotation of annotations) this.#confirmed.set(annotation.uid, annotation);
    const buried = [...this.#confirmed.values()].filter((known) => known.image === image && known.deleted);
    const shapes = new Map([...buried, ...annotations].map((known) => [known.uid, shapeOfAnnotation(known)]));
    for (const edit of this.#outbox?.edits() ?? []) {
      if (edit.image === image) overlay(shapes, edit);
    }
    this.#wires.store.replace([...shapes.values()]);
  }

  /**
   * The caps that others changed or deleted since this browser last heard of them.
   *
   * @param {number} image
   * @param {Annotation[]} annotations
   */
  #movedOn(image, annotations) {
    const now = new Map(annotations.map(({ uid, revision }) => [uid, revision]));
    const moved = [...this.#confirmed.values()].filter((known) => {
      return known.image === image && now.get(known.uid) !== (known.deleted ? undefined : known.revision);
    });
    for (const { uid } of moved) this.#confirmed.delete(uid);
    return new Set(moved.map(({ uid }) => uid));
  }

  /** @type {(outcomes: Outcome[]) => void} */
  settle(outcomes) {
    for (const outcome of outcomes) {
      const edit = this.#outbox?.edits().find(({ id }) => id === outcome.edit);
      this.#flying = this.#flying.filter((id) => id !== outcome.edit);
      if (!edit) continue;
      if (outcome.outcome === "accepted") this.#accept(edit, outcome.annotation);
      else if (outcome.outcome === "conflict") this.#clash(edit, outcome.theirs, outcome.user);
      else this.#refuse(edit, outcome.reason);
    }
    if (this.#flying.length === 0) clearTimeout(this.#timer);
    this.pump();
  }

  /** @type {(edit: Edit, annotation: Annotation) => void} */
  #accept(edit, annotation) {
    this.#outbox?.settle(edit.id);
    this.#confirmed.set(annotation.uid, annotation);
    this.#adopt(annotation);
  }

  /**
   * Takes the server's word for a cap, unless newer words of ours are still to be sent.
   *
   * @param {Annotation} annotation
   */
  #adopt(annotation) {
    if (annotation.image !== this.image || this.#outbox?.lastOf(annotation.uid)) return;
    const before = this.#wires.store.get(annotation.uid);
    const shape = shapeOfAnnotation(annotation);
    const cap = before && sameCap(before.cap, shape.cap) ? before.cap : shape.cap;
    this.#wires.store.apply([{ before, after: { ...shape, cap } }], "remote");
  }

  /** @type {(edit: Edit, theirs: Annotation, user: string) => void} */
  #clash(edit, theirs, user) {
    const last = this.#outbox?.lastOf(edit.annotation) ?? edit;
    this.#outbox?.hold({ ...edit, cap: last.cap });
    this.#confirmed.set(theirs.uid, theirs);
    this.clashes = this.clashes.filter(({ uid }) => uid !== theirs.uid);
    this.clashes.push({ uid: theirs.uid, image: edit.image, theirs, user });
  }

  /** @type {(edit: Edit, reason: string) => void} */
  #refuse(edit, reason) {
    this.#outbox?.drop(edit.annotation);
    this.#histories.get(edit.image)?.forget(new Set([edit.annotation]));
    this.#wires.refused(reason);
    const known = this.#confirmed.get(edit.annotation);
    const shape = this.#wires.store.get(edit.annotation);
    if (known) this.#adopt(known);
    else if (shape)
      this.#wires.store.apply([{ before: shape, after: { ...shape, deleted: true } }], "remote");
  }

  /**
   * Ends a conflict: what this browser shows goes on top of theirs, or theirs takes its place.
   *
   * @param {Clash} clash
   * @param {"mine" | "theirs"} whose
   */
  resolve(clash, whose) {
    const mine = this.#outbox?.lastOf(clash.uid);
    this.clashes = this.clashes.filter((other) => other !== clash);
    this.#outbox?.drop(clash.uid);
    this.#histories.get(clash.image)?.forget(new Set([clash.uid]));
    if (whose === "mine" && mine) {
      this.#outbox?.add([{ ...mine, id: newId(), base: clash.theirs.revision }]);
    } else {
      this.#adopt(clash.theirs);
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
    const moved = annotations.filter(
      ({ uid, revision }) => revision > (this.#confirmed.get(uid)?.revision ?? 0),
    );
    this.#histories.get(image)?.forget(new Set(moved.map(({ uid }) => uid)));
    for (const annotation of annotations) {
      if (annotation.revision < (this.#confirmed.get(annotation.uid)?.revision ?? 0)) continue;
      this.#confirmed.set(annotation.uid, annotation);
      this.#adopt(annotation);
    }
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
