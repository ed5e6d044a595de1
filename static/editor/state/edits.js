/**
 * What is done to the selected caps.
 *
 * @module
 */

import { nudgedHandle } from "../geometry/handles.js";
import { isPrediction, movedShape, withCap } from "../geometry/shapes.js";
import { changed } from "./changes.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../protocol.js").Cap} Cap */
/** @typedef {import("./editor_state.js").EditorState} EditorState */

const NUDGES_END_MS = 400;

/**
 * Changes the selected caps as `change` says; null leaves a cap alone.
 *
 * @param {EditorState} state
 * @param {(cap: Cap, shape: Shape) => Cap | null} change
 */
export function changeSelected(state, change) {
  state.commitDrafts();
  changeShapes(state, state.selected, change);
}

/** Likewise the selected caps, or with none selected the one under the pointer. @type {(state: EditorState, change: (shapes: Shape[]) => (cap: Cap) => Cap | null) => void} */
export function changeMeant(state, change) {
  state.commitDrafts();
  const { hovered } = state.selection;
  const pointed = hovered !== null && !state.layers.allHidden ? state.items.get(hovered) : null;
  const meant = state.selected.length || !pointed ? state.selected : [pointed];
  changeShapes(state, meant, change(meant));
}

/** @type {(state: EditorState, shapes: Shape[], change: (cap: Cap, shape: Shape) => Cap | null) => void} */
function changeShapes(state, shapes, change) {
  const changes = shapes.flatMap((shape) => {
    const cap = change(shape.cap, shape);
    return cap && cap !== shape.cap ? [changed(shape, withCap(shape, cap))] : [];
  });
  state.commit(changes);
}

/** Deletes the selected annotations and turns down the selected predictions. @type {(state: EditorState) => void} */
export function deleteSelected(state) {
  state.commitDrafts();
  const shapes = state.selected;
  if (shapes.length === 0) return;
  state.select([]);
  deleteShapes(state, shapes);
}

/**
 * Deletes what is meant: several caps that are selected, else the one that was pointed at last, else the one that
 * is selected.
 *
 * @type {(state: EditorState) => void}
 */
export function deleteMeant(state) {
  const { uids, hovered } = state.selection;
  const pointed = uids.size < 2 && hovered !== null && !state.layers.allHidden;
  const shape = pointed ? state.items.get(hovered) : null;
  if (!shape) return deleteSelected(state);
  // With nothing selected, the key pressed once more deletes no other cap. It also ends what is being nudged.
  state.select([]);
  deleteShapes(state, [shape]);
}

/** @type {(state: EditorState, shapes: Shape[]) => void} */
export function deleteShapes(state, shapes) {
  state.commit(shapes.map((shape) => changed(shape, { ...shape, deleted: true })));
}

/** Makes annotations of the selected predictions. @type {(state: EditorState) => void} */
export function acceptSelected(state) {
  state.commitDrafts();
  accept(state, state.selected);
}

/** @type {(state: EditorState, shapes: Shape[]) => void} */
export function accept(state, shapes) {
  state.commit(shapes.filter(isPrediction).map((shape) => changed(shape, shape)));
}

/**
 * Moves the active handle, or all that is selected, by a fraction of a pixel. A burst is one step.
 *
 * @param {EditorState} state
 * @param {number} dx
 * @param {number} dy
 */
export function nudge(state, dx, dy) {
  const handle = state.selection.soleUid === null ? null : state.selection.handle;
  const moved = state.selected.map((shape) =>
    handle ? withCap(shape, nudgedHandle(shape.cap, handle, dx, dy)) : movedShape(shape, dx, dy),
  );
  if (moved.length === 0) return;
  state.drafts.commitAfter(NUDGES_END_MS, () => state.commitDrafts());
  state.propose(moved);
  state.signals.nudge.emit();
}
