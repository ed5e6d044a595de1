import { inReadingOrder } from "../../geometry/reading_order.js";

/** @typedef {import("../../state/editor_state.js").EditorState} EditorState */
/** @typedef {import("./context.js").Context} Context */

/**
 * To the next cap in reading order; from the last one the key leads on into the page.
 *
 * @type {(state: EditorState, by: number) => boolean}
 */
export function cycle(state, by) {
  const order = inReadingOrder(state.visible);
  const here = order.findIndex(({ uid }) => state.selection.has(uid));
  const next = order.at(here < 0 && by < 0 ? -1 : here + by);
  if (!next || here + by >= order.length || (here === 0 && by < 0)) return false;
  state.select([next.uid], { reveal: true });
  return true;
}

/** @type {(context: Context) => void} */
export function cancel({ state, tool, use }) {
  if (tool().cancel()) return;
  if (state.selection.uids.size) state.select([]);
  else use("select");
}
