/**
 * Edits that the server has not acknowledged, oldest first. Each is kept in the browser's storage under a
 * key of its own, so that a reload or a crash while the server is away loses nothing, and an
 * acknowledgement takes one key away and writes nothing.
 *
 * @module
 */

import { keyOf, storedUnder } from "./stored_edits.js";

/** @typedef {import("../protocol.js").Edit} Edit */
/** @typedef {{key: string, set: number, held: boolean, edit: Edit}} Entry  `held` back until a person has decided */

export class Outbox {
  /** By the id of the edit, in the order of sending. @type {Map<string, Entry>} */
  #entries = new Map();
  /** The same by annotation. @type {Map<string, Entry[]>} */
  #ofAnnotation = new Map();
  /** What the storage had no room for. @type {Set<Entry>} */
  #unkept = new Set();
  /** The number of the next change set. */
  #next = 0;
  #storage;
  #prefix;

  /**
   * @param {Storage | null} storage  null where the browser has none
   * @param {string} prefix  of this project and tab
   */
  constructor(storage, prefix) {
    this.#storage = storage;
    this.#prefix = prefix;
    this.adopt(prefix);
  }

  /**
   * Takes over what stands under a prefix: this tab's own, or that of a closed tab which has left it unsent.
   *
   * @param {string} prefix
   */
  adopt(prefix) {
    const first = this.#next;
    for (const { key, set, index, edits } of storedUnder(this.#storage, prefix)) {
      edits.forEach((edit, i) => this.#put(edit, { set: first + set, index: index + i, stored: key }));
      // Written anew before it is taken away: a crash in between leaves edits twice, which does no harm.
      if (this.#entries.get(edits[0].id)?.key !== key) this.#take(key);
    }
  }

  /**
   * Keeps one change set until it is acknowledged.
   *
   * @param {Edit[]} edits
   */
  add(edits) {
    const set = this.#next;
    edits.forEach((edit, index) => this.#put(edit, { set, index }));
  }

  /** @type {(edit: Edit, where: {set: number, index: number, stored?: string}) => void} */
  #put(edit, { set, index, stored }) {
    if (this.#entries.has(edit.id)) return;
    const entry = { key: keyOf(this.#prefix, set, index), set, held: false, edit };
    this.#entries.set(edit.id, entry);
    this.#ofAnnotation.set(edit.annotation, [...this.#entriesOf(edit.annotation), entry]);
    this.#next = Math.max(this.#next, set + 1);
    if (stored !== entry.key) this.#keep(entry);
  }

  /** @type {(uid: string) => Entry[]} */
  #entriesOf(uid) {
    return this.#ofAnnotation.get(uid) ?? [];
  }

  /** The change set to send next; empty when nothing is to be sent. */
  head() {
    /** @type {Entry[]} */
    const head = [];
    for (const entry of this.#entries.values()) {
      if (entry.held) continue;
      if (head.length && entry.set !== head[0].set) break;
      head.push(entry);
    }
    return head.map(({ edit }) => edit);
  }

  /** Everything not acknowledged, oldest first. */
  edits() {
    return [...this.#entries.values()].map(({ edit }) => edit);
  }

  /** @type {(id: string) => Edit | null} */
  get(id) {
    return this.#entries.get(id)?.edit ?? null;
  }

  /** The newest edit of an annotation. @type {(uid: string) => Edit | null} */
  lastOf(uid) {
    return this.#entriesOf(uid).at(-1)?.edit ?? null;
  }

  /** How many edits wait for an acknowledgement: all but those that wait for a person. */
  get waiting() {
    return [...this.#entries.values()].filter(({ held }) => !held).length;
  }

  /** Whether everything that waits would survive a reload. */
  get kept() {
    return this.#unkept.size === 0;
  }

  /** Forgets an edit that is on the server's disk. @type {(id: string) => void} */
  acknowledged(id) {
    const entry = this.#entries.get(id);
    if (entry) this.#forget(entry);
  }

  /** Forgets every edit of one annotation. @type {(uid: string) => void} */
  drop(uid) {
    for (const entry of this.#entriesOf(uid)) this.#forget(entry);
  }

  /**
   * Puts one edit in place of all those of its annotation and holds it back until a person has decided.
   *
   * @param {Edit} edit
   */
  hold(edit) {
    this.drop(edit.annotation);
    this.add([edit]);
    for (const entry of this.#entriesOf(edit.annotation)) entry.held = true;
  }

  /** Whether a person has to decide about this annotation. @type {(uid: string) => boolean} */
  holds(uid) {
    return this.#entriesOf(uid).some(({ held }) => held);
  }

  /** @type {(entry: Entry) => void} */
  #forget(entry) {
    const { id, annotation } = entry.edit;
    const others = this.#entriesOf(annotation).filter((other) => other !== entry);
    this.#entries.delete(id);
    if (others.length) this.#ofAnnotation.set(annotation, others);
    else this.#ofAnnotation.delete(annotation);
    this.#unkept.delete(entry);
    this.#take(entry.key);
  }

  /** Takes a key away; what did not fit before may fit now. @type {(key: string) => void} */
  #take(key) {
    this.#storage?.removeItem(key);
    for (const entry of this.#unkept) if (!this.#keep(entry)) break;
  }

  /** @type {(entry: Entry) => boolean} */
  #keep(entry) {
    try {
      if (!this.#storage) throw new Error("no storage");
      this.#storage.setItem(entry.key, JSON.stringify(entry.edit));
      this.#unkept.delete(entry);
      return true;
    } catch {
      this.#unkept.add(entry);
      return false;
    }
  }
}
