/**
 * What is sent to the server of a change set, and what a cap or an image is once it is stored.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { newId } from "../ids.js";
import { stepsOf } from "../state/changes.js";
import { isOfStatus, isVerdict } from "./outbox.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("../protocol.js").Status} Status */
/** @typedef {import("../protocol.js").StatusEdit} StatusEdit */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("../state/history.js").StatusChange} StatusChange */
/** @typedef {import("./outbox.js").CapEdit} CapEdit */
/** @typedef {import("./outbox.js").Edit} Edit */
/** @typedef {{image: number, changeSet: string, takesBack: string}} Whence  what all edits of a change set have in common */

/**
 * The edits that make one change, each on the revision that the one before it leaves.
 *
 * @param {Change} change
 * @param {Whence} whence
 * @returns {CapEdit[]}
 */
export function editsOfChange(change, { image, changeSet, takesBack }) {
  const base = change.before?.revision ?? 0;
  const annotation = change.after.uid;
  return stepsOf(change).map((cap, i) => {
    return { id: newId(), annotation, image, base: base + i, cap, change_set: changeSet, takes_back: takesBack };
  });
}

/** @type {(status: StatusChange, whence: Whence) => StatusEdit} */
export function editOfStatus({ before, after }, { image, changeSet, takesBack }) {
  return { id: newId(), image, before, after, change_set: changeSet, takes_back: takesBack };
}

/** What follows from a verdict on an image. @type {Partial<Record<import("../protocol.js").Says, Status>>} */
const STATUS_AFTER = { approved: "approved", rejected: "new", sent_back: "new" };

/**
 * The status of an image once these edits are stored: what was approved is so no longer when a cap changes.
 *
 * @param {Status} status
 * @param {Edit[]} edits
 * @returns {Status}
 */
export function statusAfter(status, edits) {
  return edits.reduce((now, edit) => {
    if (isVerdict(edit)) return (edit.annotation === null && STATUS_AFTER[edit.says]) || now;
    if (isOfStatus(edit)) return edit.after;
    return now === "approved" ? "annotated" : now;
  }, status);
}

/**
 * A cap without what a refused edit changed, as far as nothing has changed that since.
 *
 * @param {Cap} cap
 * @param {{before: Cap, refused: Cap}} edit
 * @returns {Cap}
 */
export function withoutRefused(cap, { before, refused }) {
  const names = /** @type {(keyof Cap)[]} */ (Object.keys(cap));
  const spoiled = names.filter((name) => !same(refused[name], before[name]) && same(cap[name], refused[name]));
  return spoiled.length ? { ...cap, ...Object.fromEntries(spoiled.map((name) => [name, before[name]])) } : cap;
}
