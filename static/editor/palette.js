/**
 * Colours that stay apart for colour-blind eyes and stand out on white caps and on dark soil: bright
 * lines over a dark casing.
 *
 * @module
 */

export const CASING = "rgba(8, 12, 20, 0.6)";
export const SHADE = "rgba(8, 12, 20, 0.85)";

export const COLOURS = {
  outline: "#45c8ff",
  selected: "#ffffff",
  whole: "#ffb000",
  mark: "#ff6fb5",
  prediction: "#d3c6ff",
  ignored: "#9aa3ad",
  theirs: "#ff8a3d",
  draft: "#ffffff",
};

export const FILLS = {
  outline: "rgba(69, 200, 255, 0.22)",
  selected: "rgba(69, 200, 255, 0.16)",
  prediction: "rgba(201, 184, 255, 0.16)",
  ignored: "rgba(196, 202, 210, 0.6)",
  mark: "rgba(255, 111, 181, 0.14)",
};
