/**
 * Where one is: the image, and the one cap that is selected, stand in the page's address, so that a reload, a link,
 * Back and Forward lead to them; how an image was looked at is remembered for as long as the tab is there.
 *
 * @module
 */

/** @typedef {import("../state/editor_state.js").EditorState} EditorState */
/** @typedef {{image: number, look: import("../state/viewport.js").Look}} Place */
/** @typedef {{image: number, cap: string | null}} Address */

const ADDRESS = /^#\/image\/(\d+)(?:\/cap\/([^/]+))?$/;
const PLACE = "fairyring:place";

/** @type {(hash: string) => Address | null} */
export function addressIn(hash) {
  const [, image, cap] = ADDRESS.exec(hash) ?? [];
  return image === undefined ? null : { image: Number(image), cap: cap === undefined ? null : decoded(cap) };
}

/** @type {(address: Address) => string} */
export function hashOf({ image, cap }) {
  return cap === null ? `#/image/${image}` : `#/image/${image}/cap/${encodeURIComponent(cap)}`;
}

/** @type {(text: string) => string | null} */
function decoded(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return null;
  }
}

/**
 * What the page was opened with: what is in its address (laid aside by `viser/start.js`), else the last image in this
 * tab.
 *
 * @returns {Address | null}
 */
export function firstAddress() {
  const address = addressIn(Reflect.get(globalThis, "__fairyringAddress") || window.location.hash);
  const image = remembered()?.image;
  return address ?? (image === undefined ? null : { image, cap: null });
}

/** Puts an image into the address; the one before can be gone back to. @type {(image: number) => void} */
export function putInAddress(image) {
  const here = addressIn(window.location.hash);
  if (here?.image === image) return;
  const address = hashOf({ image, cap: null });
  if (here === null) window.history.replaceState(null, "", address);
  else window.history.pushState(null, "", address);
}

/** Puts the cap that is selected behind its image. @type {(state: EditorState) => void} */
export function putCapInAddress({ image, sole }) {
  const here = addressIn(window.location.hash);
  if (!image || here?.image !== image.id) return;
  const cap = sole && sole.score === null ? sole.uid : null;
  if (here.cap !== cap) window.history.replaceState(null, "", hashOf({ image: image.id, cap }));
}

/**
 * Opens what stands in the address when that changes, keeps the selected cap in it, and remembers how an image was
 * looked at when the page is left.
 *
 * @param {EditorState} state
 * @param {(image: number, cap: string | null) => void} open
 */
export function keepPlace(state, open) {
  // Back and Forward tell of a new hash as well as an address that is typed.
  window.addEventListener("hashchange", () => {
    const address = addressIn(window.location.hash);
    if (address) open(address.image, address.cap);
  });
  state.signals.selection.listen(() => putCapInAddress(state));
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
