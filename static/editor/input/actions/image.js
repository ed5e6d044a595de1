/**
 * What commands do to the image: say how far it is, go to another.
 *
 * @module
 */

import { isPrediction } from "../../geometry/shapes.js";
import { questionOf } from "../../state/finishing.js";

/** @typedef {import("./context.js").Context} Context */

const HALF_DRAWN = "An outline is still half drawn on this image: Enter closes it, W and Esc drop it.";

/** @type {(context: Context, by: 1 | -1) => void} */
export function step({ state, send }, by) {
  state.commitDrafts();
  send({ type: "step", by });
}

/** @type {(context: Context) => Promise<void>} */
export async function finishImage(context) {
  const { image } = context.state;
  if (image && (await finishAs(context, "annotated"))) context.send({ type: "step", by: 1 });
}

/**
 * Says something of the image. Predictions that nobody has looked at are asked about first: without them the
 * photo teaches that there are no caps where they are.
 *
 * @param {Context} context
 * @param {"annotated" | "approved"} status
 * @returns {Promise<boolean>} whether it was said
 */
export async function finishAs({ state, setStatus, ask, say }, status) {
  state.commitDrafts();
  const { image } = state;
  if (!image) return false;
  if (!state.halfDrawn.empty) {
    say(HALF_DRAWN);
    return false;
  }
  const open = state.items.all.filter(isPrediction).length;
  const counts = { name: image.file_name, open, caps: state.items.all.length - open };
  if (open && !(await ask(questionOf(status, counts)))) return false;
  if (state.image?.id !== image.id) return false;
  setStatus(status);
  return true;
}
