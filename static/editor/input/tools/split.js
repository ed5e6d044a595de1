/**
 * Makes two caps of one with a stroke across it. The larger stays the cap that it was; the smaller is new.
 *
 * @module
 */

import { splitCap } from "../../geometry/cuts.js";
import { newShape, withCap } from "../../geometry/shapes.js";
import { newId } from "../../ids.js";
import { changed } from "../../state/changes.js";
import { StrokeTool, aroundStroke } from "./stroke.js";
import { EDGE_PX, STRAYS_PX } from "./tool.js";

/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./stroke.js").Effect} Effect */

/** Beside the rim a stroke may begin and end so far from it, CSS pixels, without crossing it. */
const REACH_PX = 8;

const ELSEWHERE = "A stroke that splits a cap runs across it, from rim to rim.";
const BEGINS_INSIDE = "The stroke begins far inside the cap: run it across, from rim to rim.";
const ENDS_INSIDE = "The stroke ends far inside the cap: run it on to the rim.";

/** @type {(state: EditorState, say: (text: string) => void) => StrokeTool} */
export function splitTool(state, say) {
  return new StrokeTool(state, say, {
    name: "split",
    without: (stroke) => whyNot(state, stroke),
    effect: (stroke) => split(state, stroke),
    meant: (point) => state.at(point, EDGE_PX / state.viewport.view.scale),
  });
}

/**
 * Splits the selected cap, where a stroke crosses it, else the one across which it runs longest.
 *
 * @type {(state: EditorState, stroke: Point[]) => Effect | null}
 */
function split(state, stroke) {
  const { scale } = state.viewport.view;
  const how = { reach: REACH_PX / scale, tolerance: STRAYS_PX / scale };
  const { sole } = state;
  const found = [...(sole ? [sole] : []), ...aroundStroke(state, stroke, how.reach)].flatMap((before) => {
    const cut = splitCap(before.cap, stroke, how);
    return cut ? [{ before, ...cut }] : [];
  });
  const longest = found.toSorted((a, b) => b.length - a.length)[0];
  const meant = found[0]?.before === sole ? found[0] : longest;
  if (!meant) return null;
  const { before, caps: [larger, smaller] } = meant;
  const added = { before: null, after: newShape(newId(), smaller) };
  return { changes: [changed(before, withCap(before, larger)), added], replaced: [], note: "" };
}

/** Why a stroke splits nothing. @type {(state: EditorState, stroke: Point[]) => string} */
function whyNot(state, stroke) {
  if (state.at(stroke[stroke.length - 1], 0)) return ENDS_INSIDE;
  return state.at(stroke[0], 0) ? BEGINS_INSIDE : ELSEWHERE;
}
