/**
 * Ends edits: what an answer of the server changes in what this browser holds. Every function returns what
 * that changes on screen.
 *
 * @module
 */

import { same } from "../geometry/same.js";
import { shapeOfAnnotation } from "../geometry/shapes.js";
import { newId } from "../ids.js";
import { withoutRefused } from "./edits.js";
import { isOfCap } from "./outbox.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Annotation} Annotation */
/** @typedef {import("../protocol.js").Outcome} Outcome */
/** @typedef {import("../state/changes.js").Change} Change */
/** @typedef {import("./local.js").Local} Local */
/** @typedef {import("./local.js").OpenConflict} OpenConflict */
/** @typedef {import("./outbox.js").CapEdit} CapEdit */
/** @typedef {import("./outbox.js").Edit} Edit */

/** @type {(local: Local, edit: Edit, outcome: Outcome) => Change[]} */
export function settle(local, edit, outcome) {
  if (outcome.outcome === "refused") return refuse(local, edit);
  if (outcome.outcome === "conflict") return isOfCap(edit) ? ask(local, edit, outcome) : [];
  local.outbox.acknowledged(edit.id);
  if (outcome.outcome === "status") {
    local.confirmed.statuses.set(outcome.image, outcome.status);
    return [];
  }
  const { annotation } = outcome;
  const others = isOfCap(edit) && annotation.revision !== edit.base + 1;
  if (others) local.historyOf(annotation.image).forget(new Set([annotation.uid]));
  return adopt(local, annotation);
}

/**
 * Takes the server's word for a cap, unless newer words of ours are still to be sent.
 *
 * @param {Local} local
 * @param {Annotation} annotation
 * @returns {Change[]}
 */
export function adopt(local, annotation) {
  local.confirmed.put(annotation);
  if (annotation.image !== local.image || local.outbox.lastOf(annotation.uid)) return [];
  const before = local.store.get(annotation.uid);
  const shape = shapeOfAnnotation(annotation);
  const cap = before && same(before.cap, shape.cap) ? before.cap : shape.cap;
  return [{ before, after: { ...shape, cap } }];
}

/**
 * Leaves it to the person which side of a conflict is kept. Where two people have done the same there is
 * nothing to decide.
 *
 * @param {Local} local
 * @param {CapEdit} edit
 * @param {{theirs: Annotation, user: string}} other
 * @returns {Change[]}
 */
function ask(local, edit, { theirs, user }) {
  const { outbox, confirmed } = local;
  const { cap } = outbox.lastOf(edit.annotation) ?? edit;
  const moved = theirs.uid === edit.annotation ? [] : moveTo(local, edit.annotation);
  confirmed.put(theirs);
  local.conflicts = local.conflicts.filter(({ uid }) => uid !== theirs.uid);
  if (same(cap, theirs.deleted ? null : theirs.cap)) {
    outbox.drop(edit.annotation);
    local.historyOf(edit.image).forget(new Set([theirs.uid]));
    return [...moved, ...adopt(local, theirs)];
  }
  // On the base it was made on, so that a page loaded anew is asked again.
  outbox.hold({ ...edit, annotation: theirs.uid, cap });
  local.conflicts.push({ uid: theirs.uid, image: edit.image, theirs, user });
  if (edit.image !== local.image) return [];
  return [...moved, shown(local, theirs, cap)];
}

/**
 * Ours is about a cap that they have made of the same prediction; the one that we have made goes.
 *
 * @type {(local: Local, uid: string) => Change[]}
 */
function moveTo(local, uid) {
  const image = local.outbox.lastOf(uid)?.image ?? local.image;
  local.outbox.drop(uid);
  local.historyOf(image).forget(new Set([uid]));
  return removed(local, uid);
}

/** @type {(local: Local, uid: string) => Change[]} */
function removed(local, uid) {
  const before = local.store.get(uid);
  const after = before && { ...before, deleted: true, cap: { ...before.cap, prediction: null } };
  return before && after ? [{ before, after }] : [];
}

/** A cap as it looks with our side of it. @type {(local: Local, known: Annotation, cap: CapEdit["cap"]) => Change} */
function shown(local, known, cap) {
  const before = local.store.get(known.uid);
  const shape = before ?? shapeOfAnnotation(known);
  return { before, after: { ...shape, cap: cap ?? shape.cap, deleted: cap === null, revision: known.revision } };
}

/**
 * The server will never take this edit. What waits to be sent of the cap, and what can be undone of it, goes
 * on as if the edit had never been.
 *
 * @param {Local} local
 * @param {Edit} edit
 * @returns {Change[]}
 */
export function refuse(local, edit) {
  const { outbox, confirmed } = local;
  outbox.acknowledged(edit.id);
  const history = local.historyOf(edit.image);
  if (!isOfCap(edit)) {
    history.refusedStatus(edit.change_set);
    return [];
  }
  const uid = edit.annotation;
  const known = confirmed.get(uid);
  const before = known && !known.deleted ? known.cap : null;
  const refused = edit.cap;
  const without = (/** @type {import("../protocol.js").Cap} */ cap) =>
    before && refused ? withoutRefused(cap, { before, refused }) : cap;
  history.refused(edit.change_set, uid, without);
  rebase(local, { uid, base: edit.base, before, without });
  const last = outbox.lastOf(uid);
  if (!last) return known ? adopt(local, known) : removed(local, uid);
  const shape = local.store.get(uid);
  if (edit.image !== local.image || !shape) return [];
  const after = { ...shape, cap: last.cap ?? shape.cap, deleted: last.cap === null, revision: last.base + 1 };
  return [{ before: shape, after }];
}

/**
 * Has what waits of a cap go on from another revision; what then changes nothing is not sent.
 *
 * @param {Local} local
 * @param {{uid: string, base: number, before: CapEdit["cap"], without: (cap: import("../protocol.js").Cap) => import("../protocol.js").Cap}} how
 */
function rebase({ outbox }, { uid, base, before, without }) {
  let [revision, last] = [base, before];
  for (const edit of outbox.of(uid)) {
    const cap = edit.cap && without(edit.cap);
    if (same(cap, last)) outbox.acknowledged(edit.id);
    else {
      outbox.rewrite({ ...edit, base: revision, cap });
      [revision, last] = [revision + 1, cap];
    }
  }
}

/**
 * Ends a conflict: what this browser shows goes on top of theirs, or theirs takes its place.
 *
 * @param {Local} local
 * @param {OpenConflict} conflict
 * @param {"mine" | "theirs"} whose
 * @returns {Change[]}
 */
export function decide(local, conflict, whose) {
  const { outbox } = local;
  const mine = outbox.lastOf(conflict.uid);
  local.conflicts = local.conflicts.filter((other) => other !== conflict);
  outbox.drop(conflict.uid);
  local.historyOf(conflict.image).forget(new Set([conflict.uid]));
  const { theirs } = conflict;
  if (whose === "theirs" || !mine) return adopt(local, theirs);
  outbox.add([{ ...mine, id: newId(), base: theirs.revision }]);
  return conflict.image === local.image ? [shown(local, { ...theirs, revision: theirs.revision + 1 }, mine.cap)] : [];
}

/**
 * Somebody else, or a job, changed caps: undoing ours would undo theirs.
 *
 * @param {Local} local
 * @param {number} image
 * @param {Annotation[]} annotations
 * @returns {Change[]}
 */
export function takeNews(local, image, annotations) {
  const revision = (/** @type {string} */ uid) => local.confirmed.get(uid)?.revision ?? 0;
  const newer = annotations.filter((annotation) => annotation.revision > revision(annotation.uid));
  local.historyOf(image).forget(new Set(newer.map(({ uid }) => uid)));
  const current = annotations.filter((annotation) => annotation.revision >= revision(annotation.uid));
  return current.flatMap((annotation) => adopt(local, annotation));
}
