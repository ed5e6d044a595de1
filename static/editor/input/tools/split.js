/**
 * Makes two caps of one with a stroke across it. The larger stays the cap that it was; the smaller is new.
 *
 * @module
 */

import { splitCap } from "../../geometry/cuts.js";
import { newShape, withCap } from "../../geometry/shapes.js";
import { newId } from "../../ids.js";
import { changed } from "../../state/changes.js";
import { StrokeTool, meantBy } from "./stroke.js";
import { EDGE_PX, STRAYS_PX } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./stroke.js").Effect} Effect */

/** Beside the rim a stroke may begin and end so far from it, CSS pixels, without crossing it. */
const REACH_PX = 8;

const ELSEWHERE = "A stroke that splits a cap runs across it, from rim to rim.";

/** @type {(state: EditorState, say: (text: string) => void) => StrokeTool} */
export function splitTool(state, say) {
  return new StrokeTool(state, say, {
    name: "split",
    elsewhere: ELSEWHERE,
    effect: (stroke) => split(state, stroke),
    meant: (point) => state.at(point, EDGE_PX / state.viewport.view.scale),
  });
}

/** @type {(state: EditorState, stroke: Point[]) => Effect | null} */
function split(state, stroke) {
  const { scale } = state.viewport.view;
  const how = { reach: REACH_PX / scale, tolerance: STRAYS_PX / scale };
  for (const before of meantBy(state, stroke, how.reach)) {
    const caps = splitCap(before.cap, stroke, how);
    if (!caps) continue;
    const [larger, smaller] = caps;
    const added = { before: null, after: newShape(newId(), smaller) };
    return { changes: [changed(before, withCap(before, larger)), added], note: "" };
  }
  return null;
}
