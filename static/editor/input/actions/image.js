/**
 * What commands do to the image: say how far it is, go to another.
 *
 * @module
 */

import { boundsOfPoints } from "../../geometry/bounds.js";
import { isCoarse } from "../../geometry/points_needed.js";
import { isPrediction } from "../../geometry/shapes.js";
import { changed } from "../../state/changes.js";
import { questionOf } from "../../state/finishing.js";

/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
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
  if (!image || !(await finishAs(context, "annotated"))) return;
  context.send({ type: "step", by: 1 });
  context.markAgain({ quiet: true });
}

/**
 * Says something of the image. What nobody has looked at is asked about first: without its open predictions a
 * photo teaches that there are no caps where they are, and without any cap that it is empty.
 *
 * @param {Context} context
 * @param {"annotated" | "approved"} status
 * @returns {Promise<boolean>} whether it was said, and not refused, while the image stayed on screen
 */
export async function finishAs({ state, setStatus, ask, say }, status) {
  state.commitDrafts();
  const { image } = state;
  if (!image) return false;
  if (!state.halfDrawn.empty) {
    say(HALF_DRAWN);
    return false;
  }
  const question = questionOf(status, countsOf(state, image.file_name));
  const answer = question ? await ask(question) : "yes";
  if (answer === "no" || state.image?.id !== image.id) return false;
  if (answer === "down") turnDown(state);
  return (await setStatus(status)) && state.image?.id === image.id;
}

/** What nobody has accepted is no cap. @type {(state: EditorState) => void} */
function turnDown(state) {
  const open = state.items.all.filter(isPrediction);
  state.commit(open.map((shape) => changed(shape, { ...shape, deleted: true })));
}

/** @type {(state: EditorState, name: string) => import("../../state/finishing.js").Counts} */
function countsOf({ items }, name) {
  const caps = items.all.filter((shape) => !isPrediction(shape));
  const open = items.all.length - caps.length;
  const unchecked = caps.filter(({ checked, cap }) => !checked && !cap.ignored).length;
  const drawn = caps.filter(({ checked, cap }) => checked && cap.visible.length);
  const coarse = drawn.filter((shape) => isCoarse(shape, items.near(boundsOfPoints(shape.cap.visible.flat()))));
  return { name, caps: caps.length, open, unchecked, coarse: coarse.length };
}
