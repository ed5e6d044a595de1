import { isPrediction } from "./geometry/shapes.js";

/** @typedef {import("./protocol.js").ToServer} ToServer */
/** @typedef {import("./state/editor_state.js").EditorState} EditorState */

/**
 * How one gets to an image or a cap, and how the server hears which are selected.
 *
 * @param {EditorState} state
 * @param {(message: ToServer) => boolean} send
 * @param {(uid: string) => void} select  a cap of the image on screen
 */
export function goingIn(state, send, select) {
  /** @type {(image: number, cap: string | null) => void} */
  function open(image, cap) {
    state.commitDrafts();
    if (image !== state.image?.id) send({ type: "open", image, select: cap });
    else if (cap) select(cap);
  }

  /** @type {(image: number, uid: string) => void} */
  function showCap(image, uid) {
    if (image !== state.image?.id) open(image, uid);
    else if (state.items.get(uid)) {
      state.select([uid]);
      state.reveal({ close: true });
    }
  }

  function tellSelection() {
    const { selected } = state;
    send({
      type: "select",
      annotations: selected.flatMap((shape) => (isPrediction(shape) ? [] : shape.uid)),
      predictions: selected.flatMap((shape) => (isPrediction(shape) ? (shape.cap.prediction ?? []) : [])),
    });
  }

  return { open, showCap, tellSelection };
}
