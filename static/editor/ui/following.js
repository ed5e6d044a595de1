/**
 * Parts of the panel that the editor fills in: viser puts them into the page whenever it likes.
 *
 * @module
 */

/**
 * Runs `update` whenever something new is in the page.
 *
 * @param {() => void} update
 * @returns {() => void} to call when what it tells has changed
 */
export function keptUp(update) {
  new MutationObserver(update).observe(document.body, { childList: true, subtree: true });
  return update;
}

/** All elements of the page with a data attribute. @type {(attribute: string) => HTMLElement[]} */
export function marked(attribute) {
  return [...document.querySelectorAll(`[${attribute}]`)].filter((found) => found instanceof HTMLElement);
}

/** Sets an attribute that is not so already. @type {(element: Element, name: string, value: string) => void} */
export function put(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}
