/**
 * What commands make of caps that are there: one of several, or the same once more.
 *
 * @module
 */

import { merged } from "../../state/merging.js";

/** @typedef {import("../../state/changes.js").Change} Change */
/** @typedef {import("./context.js").Context} Context */

const WHICH_CAPS = "Select two caps or more to make one of them.";
const OF_PARTS = "These caps lie apart: they are one cap of several parts now.";
const NOTHING_COPIED = "Nothing is copied yet: Ctrl+C copies the selected caps.";
const NONE_BEFORE = "There are no caps to take from: no other photo was shown before this one, or it had none.";

/** @type {(context: Context) => void} */
export function mergeSelected({ state, say }) {
  state.commitDrafts();
  const shapes = state.selected.filter(({ cap }) => cap.visible.length);
  if (shapes.length < 2) return say(WHICH_CAPS);
  const changes = merged(shapes);
  const [{ after }] = changes;
  state.select([]);
  state.commit(changes);
  state.select([after.uid]);
  if (after.cap.visible.length > 1) say(OF_PARTS);
}

/** Text that is marked on the page is copied by the browser. @type {(context: Context) => boolean} */
export function copySelected({ state, say }) {
  const { selected, image } = state;
  if (selected.length === 0 || !image || String(window.getSelection())) return false;
  state.clipboard.copy(selected, image.id);
  say(selected.length === 1 ? "Copied." : `${selected.length} caps copied.`);
  return true;
}

/** @type {(context: Context) => void} */
export function pasteCopied(context) {
  const { state, pointer } = context;
  putDown(context, state.clipboard.paste(state.image?.id ?? 0, pointer()), NOTHING_COPIED);
}

/** @type {(context: Context) => void} */
export function pasteBefore(context) {
  const { state } = context;
  putDown(context, state.clipboard.pasteBefore(state.image?.id ?? 0), NONE_BEFORE);
}

/** They are selected, so that one drag brings all of them to their places. @type {(context: Context, changes: Change[], why: string) => void} */
function putDown({ state, say }, changes, why) {
  if (changes.length === 0) return say(why);
  state.commitDrafts();
  state.commit(changes);
  state.select(changes.map(({ after }) => after.uid));
}
