import { Pace, openOnes, progressOf } from "../state/walking.js";

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

const PLACES = "[data-fairyring-progress]";

/**
 * Writes into the panel how many caps are done and how long the rest may take, also into what viser puts there later.
 *
 * @param {EditorState} state
 */
export function showProgress(state) {
  const pace = new Pace();
  /** @type {number | null} */
  let image = null;
  const update = () => {
    const shapes = state.items.all;
    const open = openOnes(shapes).length;
    const now = performance.now();
    if (image !== state.image?.id) pace.start(open, now);
    else pace.count(open, now);
    image = state.image?.id ?? null;
    const text = state.image ? progressOf(shapes, pace.expect(open)) : "";
    for (const place of document.querySelectorAll(PLACES)) if (place.textContent !== text) place.textContent = text;
  };
  let asked = false;
  const soon = () => {
    if (asked) return;
    asked = true;
    requestAnimationFrame(() => {
      asked = false;
      update();
    });
  };
  state.signals.shapes.listen(soon);
  state.signals.picture.listen(soon);
  new MutationObserver(soon).observe(document.body, { childList: true, subtree: true });
}
