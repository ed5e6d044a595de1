/**
 * What commands say of the selected caps: marks, flags, their place in the overlap.
 *
 * @module
 */

import { areaOfRing, circleOfWhole, polygonOfCircle } from "../../geometry/caps.js";
import { changeMeant, changeSelected } from "../../state/edits.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Cap} Cap */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./context.js").Context} Context */

const MARKED = "What is selected is marked already; Shift+M takes marks away.";

/**
 * Gives a mark to those that have none: the one that was suggested where a single cap is selected, else the outline. A
 * mark that somebody placed is taken away by another key.
 *
 * @type {(context: Context) => void}
 */
export function markSelected({ state, say }) {
  const { selected, explanation } = state;
  const suggested = explanation?.mark;
  if (selected.length && selected.every(({ cap }) => cap.mark)) say(MARKED);
  changeSelected(state, (cap, { whole }) => {
    if (cap.mark) return null;
    return { ...cap, mark: suggested === "circle" && whole ? circleOfWhole(whole) : outlineAsMark(cap) };
  });
}

/** All on unless all are on already; with nothing selected, of the cap under the pointer. @type {(state: EditorState, name: "doubtful" | "ignored") => void} */
export function flag(state, name) {
  changeMeant(state, (shapes) => {
    const on = shapes.some(({ cap }) => !cap[name]);
    return (cap) => (cap[name] === on ? null : { ...cap, [name]: on });
  });
}

/** @type {(state: EditorState, by: number) => void} */
export function reorder(state, by) {
  changeSelected(state, (cap) => ({ ...cap, order: (cap.order ?? 0) + by }));
}

/**
 * The largest part, as that is where the rim shows.
 *
 * @type {(cap: Cap) => import("../../protocol.js").Polygon | null}
 */
function outlineAsMark({ visible }) {
  if (visible.length === 0) return null;
  const points = visible.reduce((a, b) => (areaOfRing(b) > areaOfRing(a) ? b : a));
  return { kind: "polygon", points };
}

/**
 * A circle mark becomes a polygon mark of the same centre, anything else a circle mark.
 *
 * @type {(cap: Cap, shape: Shape) => Cap | null}
 */
export function converted(cap, { whole }) {
  if (cap.mark?.kind === "circle") {
    return { ...cap, mark: { kind: "polygon", points: polygonOfCircle(cap.mark) } };
  }
  return whole && { ...cap, mark: circleOfWhole(whole) };
}
