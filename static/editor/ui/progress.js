import { isPrediction } from "../geometry/shapes.js";
import { Pace, openOnes, progressOf } from "../state/walking.js";
import { marked } from "./following.js";

/** @typedef {import("../geometry/shapes.js").Shape} Shape */
/** @typedef {import("../state/editor_state.js").EditorState} EditorState */

const PLACES = "[data-fairyring-progress]";

/** What the panel counts, by the names that it gives the places. @type {Record<string, (shapes: Shape[]) => string>} */
const COUNTS = {
  caps: (shapes) => {
    const real = shapes.filter((shape) => !isPrediction(shape) && !shape.cap.ignored);
    return `${real.length}, ${real.filter(({ cap }) => cap.mark).length} marked`;
  },
  ignored: (shapes) => String(shapes.filter(({ cap }) => cap.ignored).length),
  open: (shapes) => `${shapes.filter(isPrediction).length || "none"} open`,
};

/**
 * Writes into the panel how many caps there are and are done, and how long the rest may take, also into what viser puts
 * there later.
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
    for (const place of document.querySelectorAll(PLACES)) write(place, text);
    for (const place of marked("data-fairyring-count"))
      write(place, COUNTS[place.dataset.fairyringCount ?? ""]?.(shapes) ?? "");
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

/** @type {(place: Element, text: string) => void} */
function write(place, text) {
  if (place.textContent !== text) place.textContent = text;
}
