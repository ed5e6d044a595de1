/**
 * Tells the server of the window: whether it is to be dark, and how wide it is.
 *
 * @module
 */

/** @typedef {import("../protocol.js").Window} About */

/** What is to be told, and again whenever that changes. @type {(tell: () => void) => () => About} */
export function aboutWindow(tell) {
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  const narrow = window.matchMedia("(max-width: 1199px)");
  dark.addEventListener("change", tell);
  narrow.addEventListener("change", tell);
  return () => ({ type: "window", dark: dark.matches, width: Math.round(window.innerWidth) });
}
