import { EditorState } from "../../../static/editor/state/editor_state.js";
import { shapeOfAnnotation } from "../../../static/editor/geometry/shapes.js";

/** @typedef {import("../../../static/editor/geometry/shapes.js").Shape} Shape */
/** @typedef {import("../../../static/editor/protocol.js").Annotation} Annotation */
/** @typedef {import("../../../static/editor/protocol.js").Image} Image */
/** @typedef {import("../../../static/editor/protocol.js").Prediction} Prediction */
/** @typedef {import("../../../static/editor/state/changes.js").Change} Change */

/** @type {Image} */
export const IMAGE = {
  id: 1,
  file_name: "bed.png",
  path: "bed.png",
  width: 2000,
  height: 1500,
  sha256: "",
  light: null,
  form: null,
  split: null,
  status: "new",
  statistics: null,
  extra: {},
};

/**
 * The editor's state with an image open, and what was committed in it. Nobody is there to send it to.
 *
 * @param {{shapes?: Shape[], predictions?: Prediction[]}} [contents]
 */
export function openState({ shapes = [], predictions = [] } = {}) {
  /** @type {Change[][]} */
  const committed = [];
  const state = new EditorState((changes) => {
    if (changes.length === 0) return;
    committed.push(changes);
    state.store.apply(changes);
  });
  state.store.replace(shapes);
  state.open({ image: IMAGE, annotations: [], predictions, run: null, unchecked: [] });
  return { state, committed };
}

/**
 * Shapes as they come from the server.
 *
 * @type {(uid: string, cap: import("../../../static/editor/protocol.js").Cap) => Shape}
 */
export function storedShape(uid, cap) {
  const fields = { image: 1, revision: 1, deleted: false, whole: null, centre: null, centre_sd: null, extra: {} };
  return shapeOfAnnotation({ uid, cap, ...fields });
}
