/**
 * How edits stand in the browser's storage: a key is the prefix of a tab, the number of the change set, and
 * the index of the edit in it; sorted, the keys are in the order of sending. Older versions kept a whole
 * change set under one key, which ends with its number.
 *
 * @module
 */

/** @typedef {import("./outbox.js").Edit} Edit */
/** @typedef {{key: string, set: number, index: number, edits: Edit[]}} Stored  `index` of the first of the edits */

const SUFFIX = /^(\d{9,})(?:\.(\d{6,}))?$/;

/** @type {(prefix: string, set: number, index: number) => string} */
export function keyOf(prefix, set, index) {
  return `${prefix}${String(set).padStart(9, "0")}.${String(index).padStart(6, "0")}`;
}

/** @type {(storage: Storage | null, prefix: string) => string[]} */
export function keysWith(storage, prefix) {
  if (!storage) return [];
  const keys = Array.from({ length: storage.length }, (_, i) => storage.key(i) ?? "");
  return keys.filter((key) => key.startsWith(prefix)).sort();
}

/** The edits under a prefix in their order; what cannot be read is passed over. @type {(storage: Storage | null, prefix: string) => Stored[]} */
export function storedUnder(storage, prefix) {
  return keysWith(storage, prefix).flatMap((key) => {
    const [, set, index] = SUFFIX.exec(key.slice(prefix.length)) ?? [];
    const edits = set === undefined ? [] : editsIn(storage?.getItem(key) ?? "");
    return edits.length ? [{ key, set: Number(set), index: Number(index ?? 0), edits }] : [];
  });
}

/** @type {(text: string) => Edit[]} */
function editsIn(text) {
  try {
    return [JSON.parse(text)].flat().filter(isEdit);
  } catch {
    return [];
  }
}

/** @type {(value: unknown) => value is Edit} */
function isEdit(value) {
  return typeof value === "object" && value !== null && "id" in value && ["cap", "after", "says"].some((key) => key in value);
}
