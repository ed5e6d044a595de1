/**
 * What this browser holds of the images people work on: what the server last told of them, what it has not
 * acknowledged yet, what can be undone, and what a person has to decide.
 *
 * @module
 */

import { shapeOfAnnotation } from "../geometry/shapes.js";
import { newId } from "../ids.js";
import { History } from "../state/history.js";
import { Confirmed } from "./confirmed.js";
import { editOfStatus, editsOfChange, statusAfter } from "./edits.js";
import { Outbox, isOfCap } from "./outbox.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Status} Status */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/history.js").Move} Move */
/** @typedef {import("../state/store.js").Store} Store */

/**
 * An edit that was made on another revision than the server has, and the other side of it.
 *
 * @typedef {{uid: string, image: number, theirs: Annotation, user: string}} OpenConflict
 */

export class Local {
  confirmed = new Confirmed();
  outbox = new Outbox(null, "");
  /** The one on screen. */
  image = 0;
  /** @type {OpenConflict[]} */
  conflicts = [];
  /** @type {Map<number, History>} */
  #histories = new Map();

  /** @param {Store} store  the caps on screen */
  constructor(store) {
    this.store = store;
  }

  /** @type {(image: number) => History} */
  historyOf(image) {
    let history = this.#histories.get(image);
    if (!history) this.#histories.set(image, (history = new History()));
    return history;
  }

  /** A cap as it looks here, also where it is not on screen. @type {(uid: string) => Shape | null} */
  current(uid) {
    const known = this.confirmed.get(uid);
    return this.store.get(uid) ?? (known ? shapeOfAnnotation(known) : null);
  }

  /** The status of an image as it looks here. @type {(image: number) => Status} */
  statusOf(image) {
    const waiting = this.outbox.edits().filter((edit) => edit.image === image);
    return statusAfter(this.confirmed.statuses.get(image) ?? "new", waiting);
  }

  /**
   * Shows what is done, and puts the edits that do it into the outbox.
   *
   * @param {number} image
   * @param {string} changeSet
   * @param {Move} move
   */
  carryOut(image, changeSet, { takesBack, changes, status, verdict }) {
    const { outbox, store } = this;
    const whence = { image, changeSet, takesBack };
    const edits = changes.map((change) => (outbox.holds(change.after.uid) ? [] : editsOfChange(change, whence)));
    const shown = changes.map((change, i) => {
      const revision = (change.before?.revision ?? 0) + edits[i].length;
      return { ...change, after: { ...change.after, revision } };
    });
    store.apply(shown);
    const said = verdict ? [{ ...verdict, id: newId(), image, change_set: changeSet }] : [];
    const all = [...edits.flat(), ...(status ? [editOfStatus(status, whence)] : []), ...said];
    if (all.length) outbox.add(all);
    for (const { after } of changes) this.#foldIntoHeld(after);
  }

  /**
   * What a person goes on changing while a conflict waits belongs to their side of it.
   *
   * @type {(shape: Shape) => void}
   */
  #foldIntoHeld(shape) {
    const { outbox } = this;
    const held = outbox.holds(shape.uid) ? outbox.lastOf(shape.uid) : null;
    if (held) outbox.hold({ ...held, cap: shape.deleted ? null : shape.cap });
  }

  /**
   * Opens an image as the store has it, with what is still unacknowledged applied over it.
   *
   * @param {import("../protocol.js").Image} image
   * @param {Annotation[]} annotations
   * @param {string[]} unchecked  the uids of those that no person has looked at
   */
  open({ id: image, status }, annotations, unchecked) {
    this.image = image;
    const history = this.historyOf(image);
    history.forget(this.confirmed.refresh(image, annotations));
    if ((this.confirmed.statuses.get(image) ?? status) !== status) history.forgetStatus();
    this.confirmed.statuses.set(image, status);
    const open = new Set(unchecked);
    const all = [...this.confirmed.deletedOf(image), ...annotations];
    const shapes = new Map(all.map((known) => [known.uid, shapeOfAnnotation(known, !open.has(known.uid))]));
    this.#overlay(shapes);
    this.store.replace([...shapes.values()]);
  }

  /** What the unacknowledged edits change of what is shown. @returns {Change[]} */
  unshown() {
    const shapes = new Map(this.store.all().map((shape) => [shape.uid, shape]));
    this.#overlay(shapes);
    return [...shapes.values()].flatMap((after) => {
      const before = this.store.get(after.uid);
      return before === after ? [] : { before, after };
    });
  }

  /** @type {(shapes: Map<string, Shape>) => void} */
  #overlay(shapes) {
    for (const edit of this.outbox.edits()) {
      if (edit.image === this.image && isOfCap(edit)) overlay(shapes, edit);
    }
  }
}

/** @type {(shapes: Map<string, Shape>, edit: import("./outbox.js").CapEdit) => void} */
function overlay(shapes, edit) {
  const before = shapes.get(edit.annotation);
  const cap = edit.cap ?? before?.cap;
  if (!cap) return;
  shapes.set(edit.annotation, {
    uid: edit.annotation,
    cap,
    revision: edit.base + 1,
    deleted: edit.cap === null,
    whole: before?.whole ?? null,
    centre: before?.centre ?? null,
    score: null,
    checked: true,
    doubt: before?.doubt ?? 0,
  });
}
