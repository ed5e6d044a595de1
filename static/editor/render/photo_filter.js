/**
 * What the browser does to the photo's colours while it puts it on screen; the photo itself stays as it is.
 *
 * @module
 */

/** @typedef {import("../state/photo_look.js").Look} Look */

const ID = "fairyring-photo-filter";

/** Which column of a colour matrix is taken for all three. @type {Record<string, number>} */
const COLUMNS = { red: 0, green: 1, blue: 2 };

/**
 * @param {HTMLElement} host  where the filter's definition lives
 * @returns {(look: Look) => string} what CSS calls the filter that makes a photo look so
 */
export function photoFilter(host) {
  const holder = document.createElement("div");
  holder.hidden = true;
  holder.innerHTML = `<svg width="0" height="0" aria-hidden="true"><filter id="${ID}" color-interpolation-filters="sRGB"><feColorMatrix type="matrix" /><feComponentTransfer><feFuncR type="gamma" /><feFuncG type="gamma" /><feFuncB type="gamma" /></feComponentTransfer></filter></svg>`;
  // A filter of an element that is not displayed counts for nothing.
  holder.hidden = false;
  holder.className = "fairyring-filters";
  host.append(holder);
  const matrix = holder.querySelector("feColorMatrix");
  const curves = holder.querySelectorAll("feFuncR, feFuncG, feFuncB");
  return ({ brightness, contrast, gamma, channel }) => {
    matrix?.setAttribute("values", matrixOf(channel));
    for (const curve of curves) curve.setAttribute("exponent", String(1 / gamma));
    const parts = [];
    if (gamma !== 1 || channel !== "all") parts.push(`url(#${ID})`);
    if (brightness !== 1) parts.push(`brightness(${brightness})`);
    if (contrast !== 1) parts.push(`contrast(${contrast})`);
    return parts.join(" ");
  };
}

/** The matrix that shows one channel as grey, or all as they are. @type {(channel: string) => string} */
export function matrixOf(channel) {
  const rows = [0, 1, 2].map((row) => {
    const column = COLUMNS[channel] ?? row;
    return [0, 1, 2, 3, 4].map((at) => Number(at === column)).join(" ");
  });
  return [...rows, "0 0 0 1 0"].join(" ");
}
