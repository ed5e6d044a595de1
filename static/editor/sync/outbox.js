/**
 * Edits that the server has not acknowledged, oldest first. Each is kept in the browser's storage under a
 * key of its own, so that a reload or a crash while the server is away loses nothing, and an
 * acknowledgement takes one key away and writes nothing.
 *
 * @module
 */

import { keyOf, storedUnder } from "./stored_edits.js";

/** @typedef {import("../protocol.js").Edit} CapEdit */
/** @typedef {import("../protocol.js").StatusEdit} StatusEdit */
/** @typedef {import("../protocol.js").Verdict} Verdict */
/** @typedef {CapEdit | StatusEdit | Verdict} Edit */
/** @typedef {{key: string, set: number, held: boolean, edit: Edit, text: string}} Entry  `held` back until a person has decided */

/** How much is sent at once: the server answers a piece in about a second. */
const PIECE = { edits: 100, characters: 500_000 };

/** @type {(edit: Edit) => edit is CapEdit} */
export function isOfCap(edit) {
  return "cap" in edit;
}

/** @type {(edit: Edit) => edit is Verdict} */
export function isVerdict(edit) {
  return "says" in edit;
}

/** @type {(edit: Edit) => edit is StatusEdit} */
export function isOfStatus(edit) {
  return "after" in edit;
}

export class Outbox {
  /** By the id of the edit, in the order of sending. @type {Map<string, Entry>} */
  #entries = new Map();
  /** Those of caps by annotation. @type {Map<string, Entry[]>} */
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
    const entry = { key: keyOf(this.#prefix, set, index), set, held: false, edit, text: JSON.stringify(edit) };
    this.#entries.set(edit.id, entry);
    if (isOfCap(edit)) this.#ofAnnotation.set(edit.annotation, [...this.#entriesOf(edit.annotation), entry]);
    this.#next = Math.max(this.#next, set + 1);
    if (stored !== entry.key) this.#keep(entry);
  }

  /** @type {(uid: string) => Entry[]} */
  #entriesOf(uid) {
    return this.#ofAnnotation.get(uid) ?? [];
  }

  /** What is to be sent next, a change set or a piece of one; empty when there is nothing. */
  head() {
    /** @type {Entry[]} */
    const head = [];
    let characters = 0;
    for (const entry of this.#entries.values()) {
      if (entry.held) continue;
      characters += entry.text.length;
      const full = head.length === PIECE.edits || characters > PIECE.characters;
      if (head.length && (full || entry.set !== head[0].set)) break;
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

  /** The edits of an annotation, oldest first. @type {(uid: string) => CapEdit[]} */
  of(uid) {
    return this.#entriesOf(uid).flatMap(({ edit }) => (isOfCap(edit) ? edit : []));
  }

  /** The newest edit of an annotation. @type {(uid: string) => CapEdit | null} */
  lastOf(uid) {
    return this.of(uid).at(-1) ?? null;
  }

  /** Puts another edit in the place of the one with its id. @type {(edit: Edit) => void} */
  rewrite(edit) {
    const entry = this.#entries.get(edit.id);
    if (!entry) return;
    Object.assign(entry, { edit, text: JSON.stringify(edit) });
    this.#keep(entry);
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
   * @param {CapEdit} edit
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
    const { edit } = entry;
    this.#entries.delete(edit.id);
    if (isOfCap(edit)) {
      const others = this.#entriesOf(edit.annotation).filter((other) => other !== entry);
      if (others.length) this.#ofAnnotation.set(edit.annotation, others);
      else this.#ofAnnotation.delete(edit.annotation);
    }
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
      this.#storage.setItem(entry.key, entry.text);
      this.#unkept.delete(entry);
      return true;
    } catch {
      this.#unkept.add(entry);
      return false;
    }
  }
}
