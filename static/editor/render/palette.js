/**
 * Colours that stay apart for colour-blind eyes and stand out on white caps and on dark soil: bright
 * lines over a dark casing.
 *
 * @module
 */

export const CASING = "rgba(8, 12, 20, 0.6)";
export const SHADE = "rgba(8, 12, 20, 0.85)";

/** Over a line that is to go. */
export const FADED = "rgba(58, 72, 88, 0.75)";

export const COLOURS = {
  outline: "#45c8ff",
  checked: "#45c8ff",
  selected: "#ffffff",
  whole: "#ffb000",
  mark: "#ff6fb5",
  prediction: "#d3c6ff",
  ignored: "#9aa3ad",
  theirs: "#ff8a3d",
  refused: "#ff5c6c",
  predicted: "#ff7bff",
  draft: "#ffffff",
  uncertainty: "#ff8a3d",
};

/**
 * What an arc of the selected outline is called and how it is drawn; the dash alone tells them apart.
 *
 * @type {Record<import("../protocol.js").Arc["kind"], {name: string, colour: string, dash: number[]}>}
 */
export const ARCS = {
  visible: { name: "own rim", colour: "#45c8ff", dash: [] },
  hidden: { name: "behind a neighbour", colour: "#ff7a45", dash: [9, 6] },
  border: { name: "cut off", colour: "#ffffff", dash: [14, 5, 1, 5] },
  contact: { name: "touching", colour: "#7df0b4", dash: [24, 7] },
  concave: { name: "hollow", colour: "#f6f04e", dash: [1, 6] },
};

export const FILLS = {
  outline: "rgba(69, 200, 255, 0.17)",
  checked: "rgba(69, 200, 255, 0.05)",
  selected: "rgba(69, 200, 255, 0.12)",
  prediction: "rgba(201, 184, 255, 0.16)",
  open: "rgba(132, 60, 255, 0.45)",
  ignored: "rgba(196, 202, 210, 0.6)",
  mark: "rgba(255, 111, 181, 0.14)",
  uncertainty: "rgba(255, 138, 61, 0.28)",
};
