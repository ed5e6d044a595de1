/**
 * What the panel lists of the selected cap's rim: each piece can be called something else there.
 *
 * @module
 */

import { withCap } from "../geometry/shapes.js";
import { TOLD_KINDS, called, uncalled } from "../geometry/told_arcs.js";
import { changed } from "../state/changes.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

/** @type {(state: EditorState) => void} */
export function listenToArcs(state) {
  document.addEventListener("change", ({ target }) => {
    if (!(target instanceof HTMLSelectElement) || !target.dataset.fairyringArc) return;
    const { sole, explanation } = state;
    // The panel may still show how the rim was before something else was changed.
    const arc = explanation?.arcs.find(({ points }) => placeOf(points) === target.dataset.fairyringArc);
    if (!sole || !arc) return;
    const kind = TOLD_KINDS.find((each) => each === target.value);
    const cap = kind ? called(sole.cap, kind, arc.points) : uncalled(sole.cap, arc.points);
    state.commit([changed(sole, withCap(sole, cap))]);
  });
}

/** Where an arc begins, as the panel names it. @type {(points: number[]) => string} */
function placeOf([x, y]) {
  return `${x},${y}`;
}
