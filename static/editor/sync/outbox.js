/**
 * Edits that the server has not acknowledged, oldest first. They are kept in the browser's storage, one
 * entry a change set, so that a reload or a crash while the server is away loses nothing.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Edit} Edit */
/** @typedef {{key: string, held: boolean, edits: Edit[]}} Batch */

export class Outbox {
  /** @type {Batch[]} */
  #batches = [];
  #next = 0;
  #unkept = new Set();
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
   * Takes over what another tab, now closed, has left unsent.
   *
   * @param {string} prefix
   */
  adopt(prefix) {
    for (const key of keysWith(this.#storage, prefix)) {
      const edits = parsed(this.#storage?.getItem(key) ?? "");
      if (prefix !== this.#prefix) this.#storage?.removeItem(key);
      if (edits.length === 0) continue;
      if (prefix === this.#prefix) {
        this.#batches.push({ key, held: false, edits });
        this.#next = Math.max(this.#next, Number(key.slice(prefix.length)) + 1);
      } else {
        this.add(edits);
      }
    }
  }

  /**
   * Keeps one change set until it is settled.
   *
   * @param {Edit[]} edits
   */
  add(edits) {
    const batch = { key: this.#prefix + String(this.#next++).padStart(9, "0"), held: false, edits };
    this.#batches.push(batch);
    this.#keep(batch);
  }

  /** The change set to send next. @returns {Batch | null} */
  head() {
    return this.#batches.find((batch) => !batch.held) ?? null;
  }

  /** Everything not settled, oldest first. */
  edits() {
    return this.#batches.flatMap((batch) => batch.edits);
  }

  /** @type {(uid: string) => Edit | null} */
  lastOf(uid) {
    return this.edits().findLast((edit) => edit.annotation === uid) ?? null;
  }

  /** The edits that wait for an acknowledgement: all but those that wait for a person. */
  get waiting() {
    return this.#batches.reduce((count, batch) => count + (batch.held ? 0 : batch.edits.length), 0);
  }

  /** Whether everything that waits would survive a reload. */
  get kept() {
    return this.#unkept.size === 0;
  }

  /**
   * The edit is settled: acknowledged, or refused for good.
   *
   * @param {string} id
   */
  settle(id) {
    this.#filter((edit) => edit.id !== id);
  }

  /**
   * Forgets every edit of one annotation.
   *
   * @param {string} uid
   */
  drop(uid) {
    this.#filter((edit) => edit.annotation !== uid);
  }

  /**
   * Puts one edit in place of all those of its annotation and holds it back until a person has decided.
   *
   * @param {Edit} edit
   */
  hold(edit) {
    this.drop(edit.annotation);
    this.add([edit]);
    this.#batches[this.#batches.length - 1].held = true;
  }

  /** @type {(uid: string) => boolean} */
  holds(uid) {
    return this.#batches.some((batch) => batch.held && batch.edits[0].annotation === uid);
  }

  /** @type {(wanted: (edit: Edit) => boolean) => void} */
  #filter(wanted) {
    for (const batch of this.#batches) {
      const edits = batch.edits.filter(wanted);
      if (edits.length === batch.edits.length) continue;
      batch.edits = edits;
      if (edits.length) this.#keep(batch);
      else this.#forget(batch);
    }
    this.#batches = this.#batches.filter((batch) => batch.edits.length > 0);
  }

  /** @type {(batch: Batch) => void} */
  #keep(batch) {
    try {
      if (!this.#storage) throw new Error("no storage");
      this.#storage.setItem(batch.key, JSON.stringify(batch.edits));
      this.#unkept.delete(batch.key);
    } catch {
      this.#unkept.add(batch.key);
    }
  }

  /** @type {(batch: Batch) => void} */
  #forget(batch) {
    this.#storage?.removeItem(batch.key);
    this.#unkept.delete(batch.key);
  }
}

/** @type {(storage: Storage | null, prefix: string) => string[]} */
export function keysWith(storage, prefix) {
  if (!storage) return [];
  const keys = Array.from({ length: storage.length }, (_, i) => storage.key(i) ?? "");
  return keys.filter((key) => key.startsWith(prefix)).sort();
}

/** @type {(text: string) => Edit[]} */
function parsed(text) {
  try {
    const edits = JSON.parse(text);
    return Array.isArray(edits) ? edits : [];
  } catch {
    return [];
  }
}
