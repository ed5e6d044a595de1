/**
 * What commands do on the way through a bed.
 *
 * @module
 */

import { inReadingOrder } from "../../geometry/reading_order.js";
import { boundsOf, withCap } from "../../geometry/shapes.js";
import { changed } from "../../state/changes.js";
import { accept } from "../../state/edits.js";
import { atLeast, checkAndGoOn, openOnes } from "../../state/walking.js";

/** @typedef {import("./context.js").Context} Context */

const ALL_CHECKED = "Every cap that is shown is checked.";
const NONE_OPEN = "No open predictions are shown.";
const NO_BUDS = "No cap is smaller than 30 pixels.";
/** Caps smaller than this, image pixels, are buds. */
const BUD_PX = 30;

/** @type {(context: Context) => void} */
export function check({ state, say }) {
  if (!checkAndGoOn(state)) say(ALL_CHECKED);
}

/** Selects the next open cap in reading order, from the last one on the first again. @type {(context: Context) => void} */
export function goToOpen({ state, say }) {
  const order = inReadingOrder(state.visible);
  const here = order.findLastIndex(({ uid }) => state.selection.has(uid));
  const [next] = openOnes([...order.slice(here + 1), ...order.slice(0, here + 1)]);
  if (!next) return say(ALL_CHECKED);
  state.select([next.uid], { reveal: true });
}

/** Makes annotations of the open predictions from a score on that the person chooses. @type {(context: Context) => Promise<void>} */
export async function acceptFrom({ state, askScore, say }) {
  state.commitDrafts();
  if (atLeast(state, 0).length === 0) return say(NONE_OPEN);
  const score = await askScore();
  if (score !== null) accept(state, atLeast(state, score));
}

/** Says of all buds that are shown that they count neither way. @type {(context: Context) => void} */
export function ignoreBuds({ state, say }) {
  state.commitDrafts();
  const buds = state.visible.filter((shape) => {
    const bounds = boundsOf(shape);
    return bounds && !shape.cap.ignored && Math.max(bounds.x1 - bounds.x0, bounds.y1 - bounds.y0) < BUD_PX;
  });
  if (buds.length === 0) return say(NO_BUDS);
  state.commit(buds.map((shape) => changed(shape, withCap(shape, { ...shape.cap, ignored: true }))));
  say(buds.length === 1 ? "One bud is ignored now." : `${buds.length} buds are ignored now.`);
}
