/**
 * Redraws a stretch of a cap's rim with one stroke, which begins and ends on it: along the rim it puts that
 * right, outside it adds to the cap, inside it cuts from it. The cap is the selected one, else the one to whose
 * rim both ends are nearest and along which the stroke runs. Where the stroke runs along a neighbour's rim the
 * two share a border, and what it adds beyond that its neighbours lose.
 *
 * @module
 */

import { boundsOfPoints, grown } from "../../geometry/bounds.js";
import { leftOf, snapped } from "../../geometry/borders.js";
import { areaOf, without } from "../../geometry/regions.js";
import { redrawingOf, redrawnAs } from "../../geometry/rims.js";
import { isPrediction, withCap } from "../../geometry/shapes.js";
import { changed } from "../../state/changes.js";
import { StrokeTool, aroundStroke } from "./stroke.js";
import { STRAYS_PX } from "./tool.js";

/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../protocol.js").Point} Point */
/** @typedef {import("../../state/changes.js").Change} Change */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./stroke.js").Effect} Effect */

/** So near to the rim a stroke begins and ends, CSS pixels. */
const REACH_PX = 24;
/** So near to a neighbour's rim it follows that, CSS pixels. */
const SNAP_PX = 5;
/** An open prediction that would keep less of itself than this was of the cap that is redrawn, and stays as it was said. */
const LEAST_LEFT = 0.5;

const ELSEWHERE = "A stroke begins and ends on the rim that it changes.";

/** @type {(state: EditorState, say: (text: string) => void) => StrokeTool} */
export function rimTool(state, say) {
  return new StrokeTool(state, say, {
    name: "rim",
    without: () => ELSEWHERE,
    effect: (stroke, other) => redrawn(state, stroke, other),
    meant: (point) => withRimAt(state, point),
  });
}

/** The cap on whose rim a stroke would begin: the selected one, else the nearest; else the one around it. @type {(state: EditorState, point: Point) => Shape | null} */
function withRimAt(state, point) {
  const near = state.rimsNear(point, REACH_PX / state.viewport.view.scale);
  return near.find(({ uid }) => uid === state.sole?.uid) ?? near[0] ?? state.at(point, 0);
}

/** @type {(state: EditorState, stroke: Point[], other: boolean) => Effect | null} */
function redrawn(state, stroke, other) {
  const { scale } = state.viewport.view;
  const how = { reach: REACH_PX / scale, tolerance: STRAYS_PX / scale, other };
  const meant = meantBy(state, stroke, how);
  if (!meant) return null;
  const { shape: before, found } = meant;
  const neighbours = neighboursOf(state, before, stroke);
  const rims = neighbours.flatMap(({ cap }) => cap.visible);
  const cap = redrawnAs(before.cap, found, { ...how, along: (line) => snapped(line, rims, SNAP_PX / scale) });
  if (!cap) return null;
  const losses = lossesOf(neighbours, without(cap.visible, before.cap.visible));
  const note = losses.length ? `takes from ${losses.length === 1 ? "its neighbour" : "its neighbours"}` : "";
  const { replaced } = found.redrawing;
  return { changes: [changed(before, withCap(before, cap)), ...losses], replaced, note };
}

/**
 * The cap that a stroke is about: the selected one, else of those around it the one to whose rim both ends are
 * nearest and along which the stroke runs; and what the stroke would do to it.
 *
 * @type {(state: EditorState, stroke: Point[], how: import("../../geometry/rims.js").How) => {shape: Shape, found: import("../../geometry/rims.js").Found} | null}
 */
function meantBy(state, stroke, how) {
  const about = (/** @type {Shape} */ shape) => {
    const found = redrawingOf(shape.cap, stroke, how);
    return found ? [{ shape, found }] : [];
  };
  const [own] = state.sole ? about(state.sole) : [];
  if (own) return own;
  const all = aroundStroke(state, stroke, how.reach).flatMap(about);
  return all.sort((a, b) => a.found.redrawing.beside - b.found.redrawing.beside)[0] ?? null;
}

/** The caps that a cap may meet when it is redrawn along a stroke. @type {(state: EditorState, shape: Shape, stroke: Point[]) => Shape[]} */
function neighboursOf(state, { uid, cap }, stroke) {
  const around = boundsOfPoints([...cap.visible.flat(), ...stroke.flat()]);
  const near = grown(around, SNAP_PX / state.viewport.view.scale);
  return state.near(near).filter((shape) => shape.uid !== uid && shape.cap.visible.length > 0);
}

/** What neighbours lose of what a cap has gained. @type {(neighbours: Shape[], gained: import("../../protocol.js").Outline) => Change[]} */
function lossesOf(neighbours, gained) {
  return neighbours.flatMap((shape) => {
    const visible = leftOf(shape.cap.visible, gained);
    if (!visible || (isPrediction(shape) && areaOf(visible) < LEAST_LEFT * areaOf(shape.cap.visible))) return [];
    return [changed(shape, withCap(shape, { ...shape.cap, visible }))];
  });
}
