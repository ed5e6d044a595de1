/**
 * Where one is: the image stands in the page's address, so that a reload, a link, Back and Forward lead to
 * it; how it was looked at is remembered for as long as the tab is there.
 *
 * @module
 */

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {{image: number, look: import("../state/viewport.js").Look}} Place */

const ADDRESS = /^#\/image\/(\d+)$/;
const PLACE = "fairyring:place";

/** @type {(hash: string) => number | null} */
function imageIn(hash) {
  const [, image] = ADDRESS.exec(hash) ?? [];
  return image === undefined ? null : Number(image);
}

/**
 * The image that the page was opened with: the one in its address (laid aside by `viser/start.js`), else the
 * last one in this tab.
 *
 * @returns {number | null}
 */
export function firstImage() {
  const address = Reflect.get(globalThis, "__fairyringAddress") || window.location.hash;
  return imageIn(address) ?? remembered()?.image ?? null;
}

/** Puts an image into the address; the one before can be gone back to. @type {(image: number) => void} */
export function putInAddress(image) {
  const here = imageIn(window.location.hash);
  if (here === image) return;
  const address = `#/image/${image}`;
  if (here === null) window.history.replaceState(null, "", address);
  else window.history.pushState(null, "", address);
}

/**
 * Opens what stands in the address when that changes, and remembers how an image was looked at when the page
 * is left.
 *
 * @param {EditorState} state
 * @param {(image: number) => void} open
 */
export function keepPlace(state, open) {
  // Back and Forward tell of a new hash as well as an address that is typed.
  window.addEventListener("hashchange", () => {
    const image = imageIn(window.location.hash);
    if (image !== null) open(image);
  });
  window.addEventListener("pagehide", () => {
    if (state.image) remember({ image: state.image.id, look: state.viewport.look });
  });
  const before = remembered();
  if (before) state.viewport.expect(before.image, before.look);
}

/** @type {(place: Place) => void} */
function remember(place) {
  try {
    window.sessionStorage.setItem(PLACE, JSON.stringify(place));
  } catch {
    // The photo is shown as a whole then.
  }
}

/** @returns {Place | null} */
function remembered() {
  try {
    const { image, look } = JSON.parse(window.sessionStorage.getItem(PLACE) ?? "");
    const [x, y] = look?.middle ?? [0, 0];
    const known = Number.isInteger(image) && [x, y, look?.scale ?? 1].every(Number.isFinite);
    return known ? { image, look: look && { middle: [x, y], scale: look.scale } } : null;
  } catch {
    return null;
  }
}
