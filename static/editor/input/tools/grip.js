/**
 * What a press in Select takes hold of: a handle or an edge of the one selected cap, the selected caps, else nothing
 * but the view.
 *
 * @module
 */

import { insideCap } from "../../geometry/caps.js";
import { HANDLE_GAP_PX, handlesAreApart, nearestHandle } from "../../geometry/handles.js";
import { withCap } from "../../geometry/shapes.js";
import { insertedVertices, mergedVertices, nearestEdges } from "../../geometry/vertices.js";
import { CLICK_PX, EDGE_PX, GRAB_PX } from "./tool.js";

/** @typedef {import("../../geometry/handles.js").Handle} Handle */
/** @typedef {import("../../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./tool.js").Press} Press */

/**
 * @typedef {{kind: "handle", shape: Shape, handle: Handle, pull: number}
 *   | {kind: "shape", shapes: Shape[]}
 *   | {kind: "view"}
 *   | {kind: "rim"}
 *   | {kind: "band", band: import("./band.js").Band}} Grip
 */

/** How far along the outline, in CSS pixels, a dragged vertex pulls its neighbours. */
const PULL_PX = 16;

/** @type {(state: EditorState, press: Press) => Grip} */
export function gripAt(state, press) {
  const { selected, sole } = state;
  if (press.shift) return { kind: "band", band: { from: press.image, to: press.image } };
  if (press.ctrl) return { kind: "rim" };
  const taken = sole && partOf(sole, state, press);
  if (taken) return taken;
  const inside = selected.some((shape) => insideCap(shape.cap, ...press.image));
  return inside ? { kind: "shape", shapes: selected } : { kind: "view" };
}

/** A handle; else an edge, which gets a vertex. @type {(shape: Shape, state: EditorState, press: Press) => Grip | null} */
function partOf(shape, state, press) {
  const handle = handleAt(state, shape, press.image);
  if (handle) return { kind: "handle", shape, handle, pull: pixels(state, PULL_PX) };
  const edge = edgeAt(state, shape, press.image);
  if (!edge) return null;
  const { cap, vertices } = insertedVertices(shape.cap, edge.edges, edge.foot);
  return { kind: "handle", shape: { ...shape, cap }, handle: { kind: "vertex", vertices }, pull: 0 };
}

/** The handle of a cap that a press at a point of the image would take. @type {(state: EditorState, shape: Shape, at: import("../../protocol.js").Point) => Handle | null} */
export function handleAt(state, shape, at) {
  return nearestHandle(shape.cap, at, pixels(state, GRAB_PX));
}

/** Likewise the edge. @type {(state: EditorState, shape: Shape, at: import("../../protocol.js").Point) => ReturnType<typeof nearestEdges>} */
export function edgeAt(state, shape, at) {
  return nearestEdges(shape.cap, at, pixels(state, EDGE_PX));
}

/** Whether something else, a key, has committed or taken back what is being dragged. @type {(state: EditorState, grip: Grip) => boolean} */
export function hasLost(state, grip) {
  if (grip.kind !== "handle" && grip.kind !== "shape") return false;
  const shapes = grip.kind === "handle" ? [grip.shape] : grip.shapes;
  return !shapes.every(({ uid }) => state.drafts.has(uid));
}

/** A vertex that is put upon its neighbour becomes one with it, where each has a handle. @type {(state: EditorState, handle: Handle) => void} */
export function drop(state, handle) {
  const { sole } = state;
  if (sole && handle.kind === "vertex" && handlesAreApart(sole.cap, pixels(state, HANDLE_GAP_PX))) {
    const cap = mergedVertices(sole.cap, handle.vertices, pixels(state, CLICK_PX));
    if (cap.visible.flat().length < sole.cap.visible.flat().length) {
      state.selection.activate(null);
      state.propose([withCap(sole, cap)]);
    }
  }
  state.commitDrafts();
}

/** So many CSS pixels in pixels of the image. @type {(state: EditorState, css: number) => number} */
export function pixels(state, css) {
  return css / state.viewport.view.scale;
}
