/**
 * A browser's storage that is kept in memory, counts what is written, and may be too small.
 *
 * @implements {Storage}
 */
export class MemoryStorage {
  /** @type {Map<string, string>} */
  #entries = new Map();
  /** Characters of all keys and values that are there. */
  #taken = 0;
  /** Characters of all keys and values ever written. */
  written = 0;
  /** Characters that it has room for. */
  room = Infinity;

  get length() {
    return this.#entries.size;
  }

  /** A browser has its own order of keys; here the newest comes first. @type {(index: number) => string | null} */
  key(index) {
    return [...this.#entries.keys()].at(-1 - index) ?? null;
  }

  /** @type {(key: string) => string | null} */
  getItem(key) {
    return this.#entries.get(key) ?? null;
  }

  /** @type {(key: string, value: string) => void} */
  setItem(key, value) {
    const before = this.getItem(key);
    const grown = this.#taken + value.length + (before === null ? key.length : -before.length);
    if (grown > this.room) throw new Error("The storage is full.");
    this.#taken = grown;
    this.#entries.set(key, value);
    this.written += key.length + value.length;
  }

  /** @type {(key: string) => void} */
  removeItem(key) {
    this.#taken -= this.#entries.has(key) ? key.length + (this.getItem(key)?.length ?? 0) : 0;
    this.#entries.delete(key);
  }

  clear() {
    for (const key of [...this.#entries.keys()]) this.removeItem(key);
  }
}
