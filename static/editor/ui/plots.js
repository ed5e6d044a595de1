/**
 * Plots in viser's panel: says what the point under the pointer is, and opens it by a click. What the points are
 * stands in the element that the server puts after each plot (`app/panels/plots.py`).
 *
 * @module
 */

/** @typedef {{x: number, y: number, image: number, select: string | null, words: string}} Point */

const PLOTS = ".uplot";
const NOTES = "[data-fairyring-plot]";
/** Further from the pointer a dot is not meant, as a share of the plot. */
const NEAR = 0.06;

/** @type {(open: (image: number, select: string | null) => void, compare: () => void) => void} */
export function listenToPlots(open, compare) {
  document.addEventListener("pointermove", (event) => {
    const [note, point] = pointed(event);
    const line = note?.querySelector(".fr-pointed");
    if (line && point && line.textContent !== point.words) line.textContent = point.words;
  });
  document.addEventListener("click", (event) => {
    const [, point] = pointed(event);
    if (!point) return;
    compare();
    open(point.image, point.select);
  });
}

/** The note of the plot under the pointer, and the point that is meant. @type {(event: MouseEvent) => [HTMLElement | null, Point | null]} */
function pointed(event) {
  const area = event.target instanceof Element ? event.target.closest(".u-over") : null;
  const note = area && noteOf(area.closest(PLOTS));
  if (!area || !note) return [null, null];
  const box = area.getBoundingClientRect();
  const at = [(event.clientX - box.left) / box.width, 1 - (event.clientY - box.top) / box.height];
  return [note, nearest(note, at)];
}

/** Every plot has one, in the same order. @type {(plot: Element | null) => HTMLElement | null} */
function noteOf(plot) {
  const nth = [...document.querySelectorAll(PLOTS)].findIndex((each) => each === plot);
  return /** @type {HTMLElement | null} */ ([...document.querySelectorAll(NOTES)][nth] ?? null);
}

/** The place in the plot is given as shares of it, from its lower left corner. @type {(note: HTMLElement, at: number[]) => Point | null} */
function nearest(note, [x, y]) {
  const [x0, x1, y0, y1] = (note.dataset.fairyringPlot ?? "").split(" ").map(Number);
  // Along a row of images or caps only the place in the row counts, in a cloud of dots both do.
  const cloud = x0 < 0;
  /** @type {(point: Point) => number} */
  const off = (point) => {
    const dx = (point.x - x0) / (x1 - x0) - x;
    return cloud ? Math.hypot(dx, (point.y - y0) / (y1 - y0) - y) : Math.abs(dx);
  };
  const [found] = pointsOf(note).sort((a, b) => off(a) - off(b));
  return found && (!cloud || off(found) < NEAR) ? found : null;
}

/** @type {(note: HTMLElement) => Point[]} */
function pointsOf(note) {
  return (note.dataset.fairyringPoints ?? "").split(";").map((written) => {
    const [x, y, image, select, words] = written.split(" ");
    return { x: +x, y: +y, image: +image, select: decodeURIComponent(select) || null, words: decodeURIComponent(words) };
  });
}
